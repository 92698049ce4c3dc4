#!/bin/sh
# brief.sh COMPILER ARGUMENT…: compiles with little optimisation, which takes half as long, for tests of what builds: they
# set CMAKE_CXX_COMPILER_LAUNCHER to it.
for argument; do
  shift
  [ "$argument" = -O3 ] && argument=-O1
  set -- "$@" "$argument"
done
exec "$@"
