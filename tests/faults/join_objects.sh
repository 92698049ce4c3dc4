# join_objects.sh FUNCTION NAME OUTPUT OBJECT… LIBRARY: the objects and what they need of the library as one object, in
# which only FUNCTION can be linked, under NAME. (Functions of the namespace touchstone::fast. The groups that several
# objects may share are dissolved, so that a fault in a template stays in this object.)
set -eu
function=$1 name=$2 output=$3
shift 3
objects=$*
joined=$output.joined
pattern="_ZN10touchstone4fast${#function}${function}E"
symbols=$(nm --defined-only "${objects##* }" 2>/dev/null | awk -v pattern="$pattern" 'index($3, pattern) == 1 { print $3 }' | sort -u)
[ -n "$symbols" ] || { echo "join_objects.sh: no $function in ${objects##* }" >&2; exit 1; }
renaming="" wanted=""
for symbol in $symbols; do
  wanted="$wanted -u $symbol"
  renaming="$renaming --keep-global-symbol=$symbol"
done
# shellcheck disable=SC2086
ld -r --force-group-allocation $wanted -o "$joined" $objects
# shellcheck disable=SC2086
objcopy $renaming "$joined" "$output"
renaming=""
for symbol in $symbols; do
  renaming="$renaming --redefine-sym $symbol=_ZN10touchstone4fast${#name}${name}E${symbol#"$pattern"}"
done
# shellcheck disable=SC2086
objcopy $renaming "$output"
rm "$joined"
