# awk -v project=FOLDER -v folder=FOLDER -v which=all|always|none -f plant.awk faults.txt
#
# Writes the altered sources of each fault to folder/NAME/, with NAME.cpp, which is compiled; the table of those that are
# planted to folder/planted_faults.cpp; and what CMake is to do to standard output. Planted or not, a fault whose text is no
# longer in its source is an error. Files that do not change are not touched.

function fail(what) {
  print "tests/faults/faults.txt:" FNR ": " (name ? name ": " : "") what > "/dev/stderr"
  failed = 1
  exit 1
}

function contents(path,   text, line) {
  while ((getline line < path) > 0) text = text line "\n"
  close(path)
  return text
}

function write(path, text) {
  print "list(APPEND written \"" path "\")"
  if (contents(path) == text) return
  directory = path
  sub(/\/[^\/]*$/, "", directory)
  system("mkdir -p '" directory "'")
  printf "%s", text > path
  close(path)
}

function replaced(text, old, new,   result, at) {
  while ((at = index(text, old)) > 0) {
    result = result substr(text, 1, at - 1) new
    text = substr(text, at + length(old))
  }
  return result text
}

function literal(text) {
  gsub(/[\\"]/, "\\\\&", text)
  return "\"" text "\""
}

# The text after a line's first word.
function rest() { return substr($0, length($1) + 2) }

# ORIGINAL and FAULT, which are complete: replaces the one by the other.
function replace(   text) {
  if (original == "") return
  print "list(APPEND sources \"" project "/" file "\")"
  text = (file in altered) ? altered[file] : contents(project "/" file)
  if (index(text, original) == 0) fail("no longer in " file ": " original)
  altered[file] = replaced(text, original, substitute)
  original = substitute = last = ""
}

# The fault, which is complete: writes what it alters, and its place in the table.
function plant(   sources, count, i, path, names) {
  replace()
  if (name == "") return
  for (path in altered) write(folder "/" name "/" path, altered[path])
  count = split(compiled, sources, " ")
  text = ""
  for (i = 1; i <= count; ++i) text = text "#include \"" sources[i] "\"\n"
  write(folder "/" name "/" name ".cpp", text)
  if (which == "all" || (which == "always" && words ~ /,always,/)) {
    print "plant(" name " " entry ")"
    split(entry, names, "::")
    declarations = declarations "namespace touchstone::" names[1] " { extern decltype(tests::PlantedFaults::" part \
      ")::value_type::Part " name "; }\n"
    norm = words ~ /,l2,/ ? "Norm::l2" : words ~ /,linf,/ ? "Norm::linf" : ""
    rows = rows "  all." part ".push_back({{" literal(name) ", " literal(what) ", " \
      (norm ? "{0x1p-10, " norm "}" : "{}") ", " literal(harmless) ", " literal(rare) ", " (words ~ /,fuzzer,/ ? "true" : "false") "}, &" names[1] "::" name "});\n"
  }
  delete altered
  name = harmless = rare = ""
}

/^(#.*)?$/ { next }
!/^[-+] / { replace() }
$1 == "part" { plant(); part = $2; entry = $3; next }
$1 == "compile" { plant(); compiled = rest(); file = $2; next }
$1 == "fault" {
  plant()
  colon = index($0, ": ")
  words = substr($0, length($1) + 2, colon - length($1) - 2)
  gsub(/ /, "", words)
  name = words
  sub(/,.*/, "", name)
  words = words ","
  what = substr($0, colon + 2)
  next
}
$1 == "harmless" { harmless = harmless (harmless ? " " : "") rest(); next }
$1 == "rare" { rare = rare (rare ? " " : "") rest(); next }
$1 == "in" { file = $2; next }
/^- / {
  if (last == "+") replace()
  original = original (last == "-" ? "\n" : "") substr($0, 3)
  last = "-"
  next
}
/^\+ / {
  substitute = substitute (last == "+" ? "\n" : "") substr($0, 3)
  last = "+"
  next
}
{ fail("no such line: " $0) }

END {
  if (failed) exit 1
  plant()
  write(folder "/planted_faults.cpp", "#include \"tests/faults/planted_faults.hpp\"\n\n" declarations \
    "\nnamespace touchstone::tests {\n\nconst PlantedFaults& planted_faults() {\n" \
    "  static const PlantedFaults faults = [] {\n    PlantedFaults all;\n" rows \
    "    return all;\n  }();\n  return faults;\n}\n\n}  // namespace touchstone::tests\n")
}
