#!/bin/sh
# build_tbb_for_tsan.sh FOLDER: oneTBB from Debian's sources, compiled for ThreadSanitizer, installed in FOLDER/installed. The
# sanitizer does not see the atomics by which the scheduler of Debian's own library hands tasks from thread to thread,
# so all memory of a task would look unsynchronised.
set -eu
folder=$1
[ -e "$folder/installed/done" ] && exit
rm -rf "$folder"
"$(dirname "$0")/debian_sources.sh" "$folder/source" onetbb
cd "$folder"
cmake -G Ninja -S "$(echo source/onetbb-*/)" -B build -DCMAKE_BUILD_TYPE=RelWithDebInfo -DTBB_SANITIZE=thread \
  -DTBB_TEST=OFF -DTBB_STRICT=OFF -DTBBMALLOC_BUILD=OFF -DTBB_DISABLE_HWLOC_AUTOMATIC_SEARCH=ON \
  -DCMAKE_INSTALL_LIBDIR=lib -DCMAKE_INSTALL_PREFIX="$PWD/installed"
cmake --build build
cmake --install build
touch installed/done
