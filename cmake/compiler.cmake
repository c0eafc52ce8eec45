# Compiler settings for every target.
if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "" FORCE)
endif()
add_compile_options(-Wall -Wextra -Wpedantic -Wshadow -Wno-psabi)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # g++ 12 misjudges bounds inside fmt's and the standard library's inlined code at -O3.
  add_compile_options(-Wno-stringop-overflow -Wno-stringop-overread -Wno-array-bounds -Wno-restrict)
endif()
if(KAUSTIK_WARNINGS_AS_ERRORS)
  add_compile_options(-Werror)
endif()
# The baseline of Kaustik's own code; wider vectors are chosen at run time by Highway and Embree.
if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  add_compile_options(-march=x86-64-v2)
endif()
# No contraction into fused operations: results must not depend on what the compiler fuses.
add_compile_options(-ffp-contract=off -fno-math-errno)
set(CMAKE_CXX_FLAGS_RELEASE "-O3")
if(KAUSTIK_SANITIZE STREQUAL "address")
  set(kaustik_sanitizers -fsanitize=address,undefined -fno-sanitize-recover=all)
  # Half a million addresses would be moved at each start of a program, and tests start it thousands of times.
  add_link_options($<$<STREQUAL:$<TARGET_PROPERTY:TYPE>,EXECUTABLE>:-no-pie>)
  # Where memory behind a null pointer or beyond an object is used, the address sanitizer stops, too. Only null
  # pointers that become references and are never used go unseen. Without these two checks programs take a fifth
  # less time to build and a quarter less to run.
  if(NOT KAUSTIK_SANITIZE_ALL)
    list(APPEND kaustik_sanitizers -fno-sanitize=null,object-size)
  endif()
elseif(KAUSTIK_SANITIZE STREQUAL "thread")
  set(kaustik_sanitizers -fsanitize=thread)
  add_compile_definitions(KAUSTIK_THREAD_SANITIZER=1)
elseif(KAUSTIK_SANITIZE AND NOT KAUSTIK_SANITIZE STREQUAL "none")
  message(FATAL_ERROR "KAUSTIK_SANITIZE is '${KAUSTIK_SANITIZE}': it has to be none, address or thread")
endif()
if(kaustik_sanitizers)
  add_compile_options(${kaustik_sanitizers} -fno-omit-frame-pointer)
  add_link_options(${kaustik_sanitizers})
  find_program(KAUSTIK_LLD ld.lld)
  mark_as_advanced(KAUSTIK_LLD)
  if(KAUSTIK_LLD AND CMAKE_CXX_COMPILER_ID MATCHES "Clang")
    add_link_options(-fuse-ld=lld)  # half the time
  endif()
endif()
if(KAUSTIK_COVERAGE)
  add_compile_options(-fprofile-instr-generate -fcoverage-mapping)
  add_link_options(-fprofile-instr-generate)
endif()
if(kaustik_sanitizers OR KAUSTIK_COVERAGE)
  set(CMAKE_CXX_FLAGS_RELWITHDEBINFO "-O1 -gline-tables-only")
  # Programs run slowly: tests take fewer samples.
  add_compile_definitions(KAUSTIK_SLOW_BUILD=1)
endif()

# What becomes part of the libraries. They may get into shared ones, such as modules of Python; without interposition calls
# stay as direct as before. What assert() prints does not tell where the sources lay.
function(kaustik_library_options target)
  target_compile_options(${target} PRIVATE -fPIC -fno-semantic-interposition
                         -fmacro-prefix-map=${PROJECT_SOURCE_DIR}/=)
endfunction()
