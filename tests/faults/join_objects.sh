# join_objects.sh MODULE FUNCTION NAME OUTPUT OBJECT… LIBRARY: the objects and their dependencies in the library as
# one object, in which only touchstone::MODULE::FUNCTION can be linked, as touchstone::MODULE::NAME. (Groups that
# several objects may share are dissolved, so that a fault in a template stays in this object.)
set -eu
module=$1 function=$2 name=$3 output=$4
shift 4
pattern="_ZN10touchstone${#module}${module}${#function}${function}E"
symbols=$(nm --defined-only --extern-only "$@" 2>/dev/null | awk -v pattern="$pattern" 'index($3, pattern) == 1 { print $3 }' | sort -u)
[ -n "$symbols" ] || { echo "join_objects.sh: no $function in $*" >&2; exit 1; }
wanted="" kept="" renamed=""
for symbol in $symbols; do
  wanted="$wanted -u $symbol"
  kept="$kept --keep-global-symbol=$symbol"
  renamed="$renamed --redefine-sym $symbol=_ZN10touchstone${#module}${module}${#name}${name}E${symbol#"$pattern"}"
done
# shellcheck disable=SC2086
ld -r --force-group-allocation $wanted -o "$output" "$@"
# objcopy makes a unique symbol, of an inline variable, local only if it is weak.
for symbol in $(nm "$output" | awk '$2 == "u" { print $3 }'); do
  objcopy --weaken-symbol="$symbol" "$output"
done
# shellcheck disable=SC2086
objcopy $kept "$output"
# shellcheck disable=SC2086
objcopy $renamed "$output"
