# Script: writes text files into a C++ header as string constants.
#   cmake -DOUTPUT=header.h -DFILES="name1=path1;name2=path2" -P EmbedFiles.cmake
# A string literal may hold 65536 characters by the standard's advice, so long files are cut into
# adjacent literals.
set(content "#pragma once\n\n#include <string_view>\n\nnamespace app::assets {\nusing namespace std::string_view_literals;\n")
foreach(entry IN LISTS FILES)
  string(REGEX MATCH "^([^=]+)=(.+)$" ok "${entry}")
  set(name "${CMAKE_MATCH_1}")
  file(READ "${CMAKE_MATCH_2}" text)
  string(LENGTH "${text}" length)
  string(APPEND content "inline constexpr std::string_view ${name} =\n")
  set(from 0)
  while(from LESS length)
    string(SUBSTRING "${text}" ${from} 16000 piece)
    string(APPEND content "R\"asset(${piece})asset\"\n")
    math(EXPR from "${from} + 16000")
  endwhile()
  string(APPEND content "\"\"sv;\n")  # whose length is counted by the compiler itself
endforeach()
string(APPEND content "}  // namespace app::assets\n")
file(WRITE "${OUTPUT}" "${content}")
