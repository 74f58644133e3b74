# cmake -DCOMPILER=... -DFLAGS=... -DSOURCE=... -P refused.cmake: the source does not compile, and the compiler says what the source's first line
# expects.
file(STRINGS "${SOURCE}" first LIMIT_COUNT 1)
string(REGEX REPLACE "^// refused: " "" expected "${first}")
execute_process(COMMAND "${COMPILER}" ${FLAGS} -fsyntax-only "${SOURCE}" RESULT_VARIABLE code OUTPUT_VARIABLE output ERROR_VARIABLE output)
if(code EQUAL 0)
  message(FATAL_ERROR "${SOURCE} compiles, and should not")
endif()
string(REGEX REPLACE "[\n\r]+" " " output "${output}")
if(NOT output MATCHES "${expected}")
  message(FATAL_ERROR "${SOURCE} is refused, but not with '${expected}':\n${output}")
endif()
