# axis_plain_library(NAME FOLDER): the static library NAME as AXIS_PLAIN_BUILD has compiled it, without sanitizers.
function(axis_plain_library NAME FOLDER)
  add_library(${NAME} STATIC IMPORTED GLOBAL)
  set_target_properties(${NAME} PROPERTIES IMPORTED_LOCATION "${AXIS_PLAIN_BUILD}/${FOLDER}/lib${NAME}.a")
endfunction()
