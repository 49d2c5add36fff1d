# What Doxygen reads of a header. Docstrings are plain text with `code` and indented formulas: what Doxygen would take for
# a command or for HTML is escaped, formulas stand apart, and the docstring that opens a header is the header's own.
# Specialisations of Eigen's templates are details.
NR == 1 && $0 == "#pragma once" { $0 = "/// \\file" }
/struct Eigen::/ { gsub(/Eigen::[A-Za-z_:]*/, "detail") }
{ formula = /^ *\/\/\/     / }
formula && before ~ /^ *\/\/\/ [^ ]/ { print "///" }
/^ *\/\/\// && !formula && NR > 1 {
  gsub(/\\/, "&&")
  gsub(/[<>@&#]/, "\\\\&")
}
{ print; before = $0 }
