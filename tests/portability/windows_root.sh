#!/usr/bin/env bash
# windows_root.sh FOLDER: what the libraries and their tests need on Windows, in FOLDER: GMP, MPFR, oneTBB, {fmt} and
# GoogleTest, static, by mingw-w64 from Debian's sources, and this machine's headers of Eigen, CGAL, Boost and JSON for
# Modern C++. Takes some minutes.
set -euo pipefail
readonly folder=$1 toolchain=$PWD/cmake/windows.cmake root=$1.new
readonly host=x86_64-w64-mingw32

# by_configure SOURCE [OPTION…], by_cmake SOURCE [OPTION…]: builds and installs.
by_configure() {
  (cd "$1" && ./configure --host=$host CC=$host-gcc-posix CXX=$host-g++-posix --prefix="$root" --disable-shared "${@:2}" &&
    make -j "$(nproc)" && make install)
}
by_cmake() {
  cmake -G Ninja -S "$1" -B "$1-build" -DCMAKE_TOOLCHAIN_FILE="$toolchain" -DCMAKE_BUILD_TYPE=Release \
    -DBUILD_SHARED_LIBS=OFF -DCMAKE_INSTALL_PREFIX="$root" "${@:2}" && cmake --build "$1-build" --target install
}
build() {
  cmake/debian_sources.sh "$work" gmp mpfr4 onetbb fmtlib googletest && cd "$work" &&
    # Debian's source has no documents, which configure asks for.
    mkdir -p "$(echo gmp-*/)doc" && echo 'all install install-exec install-data:' >"$(echo gmp-*/)doc/Makefile.in" &&
    by_configure gmp-*/ --enable-cxx && by_configure mpfr4-*/ --with-gmp="$root" &&
    by_cmake onetbb-*/ -DTBB_TEST=OFF -DTBB_STRICT=OFF -DTBBMALLOC_BUILD=OFF &&
    by_cmake fmtlib-*/ -DFMT_TEST=OFF -DFMT_DOC=OFF && by_cmake googletest-*/
}

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
rm -rf "$root"
mkdir -p "$root"
build >"$work.log" 2>&1 || { tail -30 "$work.log" >&2; exit 1; }
rm "$work.log"
# A static oneTBB exports its functions from a DLL that has it, and does not say what it needs.
$host-objcopy --remove-section .drectve "$root/lib/libtbb12.a"
sed -i '1i find_package(Threads)' "$root/lib/cmake/TBB/TBBConfig.cmake"
ln -s /usr/include/{boost,CGAL,eigen3,nlohmann} "$root/include"
ln -s "/usr/lib/$(gcc -dumpmachine)/cmake/CGAL" /usr/share/cmake/nlohmann_json "$root/lib/cmake"
ln -s /usr/share/eigen3/cmake "$root/lib/cmake/Eigen3"
rm -rf "$folder"
mv "$root" "$folder"
