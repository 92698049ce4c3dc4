#!/bin/sh
# compile.sh SOURCE_FOLDER COMPILER ARGUMENT…: the compiler behind ccache, set up so that a clean clone in another folder
# finds what an earlier one compiled, precompiled headers included:
#   - paths below SOURCE_FOLDER count as relative;
#   - the text of a header counts, not its time, which is new in a clone;
#   - without the mode "depend" a precompiled header of other definitions would be taken for this one;
#   - a precompiled header stands for the text that it was made of (in a file beside it, ending in .sum): its own bytes
#     differ from one compilation to the next;
#   - a unit of several sources names them by absolute paths: a copy that names them relative to SOURCE_FOLDER, which is
#     among the include folders, is compiled instead.
export CCACHE_BASEDIR="$1" CCACHE_NOHASHDIR=true CCACHE_DEPEND=true CCACHE_PCH_EXTSUM=true CCACHE_MAXSIZE=10G
export CCACHE_SLOPPINESS=pch_defines,time_macros,include_file_mtime,include_file_ctime
shift

for argument; do
  shift
  case $argument in
    */Unity/unity_*.cxx)
      sed "s|#include \"$CCACHE_BASEDIR/|#include \"|" "$argument" >"${argument%.cxx}.relative.cxx"
      argument=${argument%.cxx}.relative.cxx
      ;;
  esac
  set -- "$@" "$argument"
done

# hash_of_text COMPILER ARGUMENT…: the hash of the text that the command would compile.
hash_of_text() {
  remaining=$#
  while [ "$remaining" -gt 0 ]; do
    case $1 in
      -o | -MF | -MT) shift && remaining=$((remaining - 1)) ;;
      -MD | -c) ;;
      *) set -- "$@" "$1" ;;
    esac
    shift
    remaining=$((remaining - 1))
  done
  "$@" -E -dD -P | sha256sum
}

case " $* " in
  *" -x c++-header "*) ;;
  *) exec ccache "$@" ;;
esac
output= previous=
for argument in "$@"; do
  case $previous in -o) output=$argument ;; esac
  previous=$argument
done
rm -f "$output" "$output.sum"  # the compiler, and ccache, would read the old one
hash=$(hash_of_text "$@")
ccache "$@" || exit
echo "$hash" >"$output.sum"
