# cmake -DINPUTS=<page;style;script;charts> -DOUTPUT=<file.cpp> -P embed.cmake
# Writes the files as raw string literals in the order of report_assets.hpp.
set(names report_page report_style report_script report_charts)
set(text "#include \"report_assets.hpp\"\n\nnamespace helixnav::reports {\n")
foreach(name file IN ZIP_LISTS names INPUTS)
  file(READ ${file} content)
  string(FIND "${content}" ")~helix\"" clash)
  if(NOT clash EQUAL -1)
    message(FATAL_ERROR "${file} holds the end mark of the string literal")
  endif()
  string(APPEND text "\nconst std::string_view ${name} = R\"~helix(${content})~helix\";\n")
endforeach()
string(APPEND text "\n}  // namespace helixnav::reports\n")
file(WRITE ${OUTPUT} "${text}")
