# What Doxygen is shown of a header: formulas, indented in the comments of this house, become blocks of their
# own, <words> in angle brackets are no HTML, and declarations of template instances are left out.
/^ *extern template/ { skipping = 1 }
skipping {
  if (/;$/) skipping = 0
  print ""
  next
}
/^ *\/\/\/( |$)/ {
  body = $0
  sub(/^ *\/\/\/ ?/, "", body)
  if (body ~ /^ *@/) command = 1
  if (body == "") command = 0
  formula = !command && body ~ /^    +[^ ]/
  if (formula != inFormula && body != "" && previous != "") print "///"
  if (!formula) $0 = escaped($0)
  inFormula = formula
  previous = body
  print
  next
}
{
  command = inFormula = 0
  previous = ""
  print
}
function escaped(line) {
  while (match(line, /<[a-z]+>/)) {
    line = substr(line, 1, RSTART - 1) "\\<" substr(line, RSTART + 1, RLENGTH - 2) "\\>" \
           substr(line, RSTART + RLENGTH)
  }
  return line
}
