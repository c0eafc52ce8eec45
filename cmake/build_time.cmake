# Ways to build all of Kaustik in less time. What they make is the same to the bit.
#
# PRECOMPILED_HEADERS: the headers of the standard library, fmt, Imath and gtest are parsed once.
# UNITY: several sources are compiled as one, which takes less time; but after an edit more is
# compiled again. A source that lacks an include still compiles in such builds, so builds without them
# have to be among the checks.
option(KAUSTIK_PRECOMPILED_HEADERS "Parse the libraries' headers once" OFF)
option(KAUSTIK_UNITY "Compile several sources as one" OFF)
option(KAUSTIK_CCACHE "Use ccache where it is installed" ON)
set(KAUSTIK_UNITY_SOURCES 16 CACHE STRING "Sources that are compiled as one by KAUSTIK_UNITY")
mark_as_advanced(KAUSTIK_UNITY_SOURCES)

if(KAUSTIK_CCACHE AND NOT DEFINED CMAKE_CXX_COMPILER_LAUNCHER)
  find_program(KAUSTIK_CCACHE_PROGRAM ccache)
  mark_as_advanced(KAUSTIK_CCACHE_PROGRAM)
  if(KAUSTIK_CCACHE_PROGRAM)
    # What its manual demands for precompiled headers.
    set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env
        CCACHE_SLOPPINESS=pch_defines,time_macros ${KAUSTIK_CCACHE_PROGRAM})
  endif()
endif()

# `target` uses what `owner` precompiles, and `owner` itself precompiles `header`. All that share an owner
# have the same flags; definitions may differ where no precompiled header reads them.
function(kaustik_precompile target owner header)
  if(NOT KAUSTIK_PRECOMPILED_HEADERS)
    return()
  endif()
  if(target STREQUAL owner)
    target_precompile_headers(${target} PRIVATE ${PROJECT_SOURCE_DIR}/cmake/${header})
    if(CMAKE_CXX_COMPILER_ID MATCHES "Clang")
      # Else ccache would take the time of the build for a part of the header.
      target_compile_options(${target} PRIVATE "SHELL:-Xclang -fno-pch-timestamp")
    endif()
  else()
    target_precompile_headers(${target} REUSE_FROM ${owner})
    if(NOT owner STREQUAL test_base)
      kaustik_library_options(${target})
    endif()
  endif()
endfunction()

# `target`, whose time nobody waits for: options, texts, templates that take most of the time to compile. What it
# computes is the same. Where clang++ puts in sanitizers, -O1 takes two to three times as long as -O0.
function(kaustik_hurry target)
  target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1>)
  if(NOT kaustik_sanitizers)
    kaustik_precompile(${target} kaustik_base precompiled_library.h)
    return()
  endif()
  target_compile_options(${target} PRIVATE -O0)
  if(KAUSTIK_PRECOMPILED_HEADERS AND NOT TARGET kaustik_hurried_headers)
    file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/hurried_headers.cpp CONTENT "")
    add_library(kaustik_hurried_headers OBJECT ${PROJECT_BINARY_DIR}/hurried_headers.cpp)
    target_link_libraries(kaustik_hurried_headers PRIVATE Imath::Imath fmt::fmt)
    kaustik_library_options(kaustik_hurried_headers)
    target_compile_options(kaustik_hurried_headers PRIVATE -O0)
    kaustik_precompile(kaustik_hurried_headers kaustik_hurried_headers precompiled_library.h)
  endif()
  kaustik_precompile(${target} kaustik_hurried_headers precompiled_library.h)
endfunction()

# Of sources that are compiled as one, names in unnamed namespaces must differ. Sources named after ALONE
# stay alone, and those that Highway includes, by their name, once per instruction set.
function(kaustik_unite target)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" ALONE)
  if(NOT KAUSTIK_UNITY)
    return()
  endif()
  get_target_property(sources ${target} SOURCES)
  get_target_property(folder ${target} SOURCE_DIR)
  foreach(source ${sources})
    get_filename_component(path ${source} ABSOLUTE BASE_DIR ${folder})
    file(STRINGS ${path} includes_itself REGEX "define HWY_TARGET_INCLUDE" LIMIT_COUNT 1)
    get_filename_component(name ${source} NAME)
    if(includes_itself OR name IN_LIST arg_ALONE)
      set_source_files_properties(${source} TARGET_DIRECTORY ${target}
                                  PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
    endif()
  endforeach()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON
                        UNITY_BUILD_BATCH_SIZE ${KAUSTIK_UNITY_SOURCES})
  # A parameter may be named like a constant of another file; g++ takes what is in a source for what is in a
  # header, and g++ 12 misjudges vectors that it inlines from afar.
  target_compile_options(${target} PRIVATE -Wno-shadow
                         "$<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage;-Wno-maybe-uninitialized>")
endfunction()
