# Headers of the standard library, fmt, Imath and gtest parsed once, for builds that check something else than
# includes: a source that lacks one still compiles here, so builds without it have to be among the checks.
option(KAUSTIK_PRECOMPILED_HEADERS "Parse the libraries' headers once" OFF)

# `target` uses what `owner` precompiles, and `owner` itself precompiles `header`. All that share an owner
# have the same flags; definitions may differ where no precompiled header reads them.
function(kaustik_precompile target owner header)
  if(NOT KAUSTIK_PRECOMPILED_HEADERS)
    return()
  endif()
  if(target STREQUAL owner)
    target_precompile_headers(${target} PRIVATE ${PROJECT_SOURCE_DIR}/cmake/${header})
  else()
    target_precompile_headers(${target} REUSE_FROM ${owner})
    if(owner STREQUAL kaustik_base)
      kaustik_library_options(${target})
    endif()
  endif()
endfunction()
