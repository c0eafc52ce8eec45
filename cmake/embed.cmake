# Makes the files FOLDER/PATTERN a part of `target`: HEADER declares FUNCTION() of NAMESPACE, which returns them as a
# vector of TYPE, a struct of the file's name and its bytes.
function(kaustik_embed target)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "FOLDER;PATTERN;HEADER;NAMESPACE;TYPE;FUNCTION" "")
  set(output ${PROJECT_BINARY_DIR}/embedded/${target}.cpp)
  set(script ${PROJECT_SOURCE_DIR}/cmake/embed_assets.cmake)
  file(GLOB files CONFIGURE_DEPENDS ${arg_FOLDER}/${arg_PATTERN})
  set(settings)
  foreach(name FOLDER PATTERN HEADER NAMESPACE TYPE FUNCTION)
    list(APPEND settings -D ${name}=${arg_${name}})
  endforeach()
  add_custom_command(OUTPUT ${output} COMMAND ${CMAKE_COMMAND} ${settings} -D OUTPUT=${output} -P ${script}
                     DEPENDS ${files} ${script} VERBATIM)
  target_sources(${target} PRIVATE ${output})
  set_source_files_properties(${output} TARGET_DIRECTORY ${target}
                              PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON SKIP_PRECOMPILE_HEADERS ON)
endfunction()
