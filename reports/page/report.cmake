# helixnav_embed_report(<target>): compiles the report's page, style, script and charting library into <target>.
set(HELIXNAV_PLOTLY_JS ${CMAKE_CURRENT_LIST_DIR}/node_modules/plotly.js-basic-dist-min/plotly-basic.min.js
  CACHE FILEPATH "Charting library of the report, from npm's plotly.js-basic-dist-min")

function(helixnav_embed_report target)
  set(folder ${CMAKE_CURRENT_FUNCTION_LIST_DIR})
  if(NOT EXISTS ${HELIXNAV_PLOTLY_JS})
    message(FATAL_ERROR "The report's charting library is not at ${HELIXNAV_PLOTLY_JS}.\n"
      "./dev build fetches it; by hand: npm ci --ignore-scripts --prefix ${folder}\n"
      "A copy elsewhere is named by -DHELIXNAV_PLOTLY_JS=<file>.")
  endif()
  # In this order: what a script needs at once stands before it.
  set(scripts text.js names.js unpack.js drive.js camera.js polyline.js present.js cells.js charts.js map_chart.js particles.js
    strokes.js scene_ways.js layers.js ink.js scene_landmarks.js scene_now.js scene.js player_text.js player_strip.js player.js player_controls.js
    opening.js summary.js decisions.js closures.js main.js)
  list(TRANSFORM scripts PREPEND ${folder}/)
  set(output ${CMAKE_CURRENT_BINARY_DIR}/report_assets.cpp)
  add_custom_command(OUTPUT ${output}
    COMMAND ${CMAKE_COMMAND} -DPAGE=${folder}/report.html.in -DSTYLE=${folder}/report.css "-DSCRIPTS=${scripts}"
      -DCHARTS=${HELIXNAV_PLOTLY_JS} -DOUTPUT=${output} -P ${folder}/embed.cmake
    DEPENDS ${folder}/report.html.in ${folder}/report.css ${scripts} ${HELIXNAV_PLOTLY_JS} ${folder}/embed.cmake
    COMMENT "Embedding the report page" VERBATIM)
  target_sources(${target} PRIVATE ${output})
endfunction()
