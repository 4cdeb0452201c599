# cmake -DPAGE=… -DSTYLE=… -DSCRIPTS=<a.js;b.js;…> -DCHARTS=… -DOUTPUT=<file.cpp> -P embed.cmake
# Writes the files as the raw string literals of report_assets.hpp; the scripts one after the other, as one.
set(text "#include \"report/report_assets.hpp\"\n\nnamespace helixnav::reports {\n")

function(append_literal name)
  set(all "")
  foreach(file IN LISTS ARGN)
    file(READ ${file} content)
    string(FIND "${content}" ")~helix\"" clash)
    if(NOT clash EQUAL -1)
      message(FATAL_ERROR "${file} holds the end mark of the string literal")
    endif()
    string(APPEND all "${content}")
  endforeach()
  set(text "${text}\nconst std::string_view ${name} = R\"~helix(${all})~helix\";\n" PARENT_SCOPE)
endfunction()

append_literal(report_page ${PAGE})
append_literal(report_style ${STYLE})
append_literal(report_script ${SCRIPTS})
append_literal(report_charts ${CHARTS})
string(APPEND text "\n}  // namespace helixnav::reports\n")
file(WRITE ${OUTPUT} "${text}")
