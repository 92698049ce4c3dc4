#!/usr/bin/env bash
# packages.sh FOLDER: the packages of the playground for WebAssembly: GMP, built from Debian's source, and headers: of fmt
# and of JSON for Modern C++, this machine's; of CGAL's numbers, which are GMP's. Takes some minutes.
set -euo pipefail
readonly folder=$1
readonly source='http://deb.debian.org/debian/pool/main/g/gmp/gmp_6.2.1+dfsg1.orig.tar.xz'
readonly digest=471b9e463e04362a0124f215afc5f0a4b99caedeeb62634c61bbc12988efa64c

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
curl --fail --silent --show-error --location --output "$work/gmp.tar.xz" "$source"
echo "$digest  $work/gmp.tar.xz" | sha256sum --check --quiet
tar --extract --file "$work/gmp.tar.xz" --directory "$work"
cd "$work"/gmp-*
# Debian's source has no documents, which configure asks for.
mkdir doc
echo 'all install install-exec install-data:' >doc/Makefile.in
# Where node is not Debian's, it does not look for the modules of Debian's emscripten.
export NODE_PATH=/usr/share/nodejs
emconfigure ./configure --host=none --build="$(gcc -dumpmachine)" --disable-assembly --disable-shared \
  --prefix="$work/out" CC=emcc CC_FOR_BUILD=gcc CFLAGS='-O3 -DNDEBUG' >"$work/log" 2>&1 &&
  emmake make -j "$(nproc)" >>"$work/log" 2>&1 && make install >>"$work/log" 2>&1 ||
  { tail -30 "$work/log" >&2; exit 1; }

mkdir -p "$folder.new"
cp -r "$work/out/include" "$work/out/lib" "$folder.new"
cp -r /usr/include/gmpxx.h /usr/include/fmt /usr/include/nlohmann "$folder.new/include"
# CGAL's own ask for rounding modes, which WebAssembly has not.
mkdir "$folder.new/include/CGAL"
for number in integer:mpz_class rational:mpq_class; do
  printf '#pragma once\n#include <gmpxx.h>\nnamespace CGAL {\nusing Exact_%s = %s;\n}\n' "${number%:*}" "${number#*:}" \
    >"$folder.new/include/CGAL/Exact_${number%:*}.h"
done
rm -rf "$folder"
mv "$folder.new" "$folder"
