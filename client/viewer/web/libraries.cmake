# The header-only libraries of the page, by the names that their packages give their targets.
#
# A folder of links holds those and nothing else: with /usr/include on its path, em++ would mix the
# machine's own C library into the browser's.
set(only_these ${CMAKE_BINARY_DIR}/include)
file(MAKE_DIRECTORY ${only_these})
foreach(header nlohmann tl xxhash.h)
  if(NOT EXISTS /usr/include/${header})
    message(FATAL_ERROR "/usr/include/${header} is missing: server/packages.sh names its package.")
  endif()
  file(CREATE_LINK /usr/include/${header} ${only_these}/${header} SYMBOLIC)
endforeach()

foreach(library nlohmann_json::nlohmann_json tl::expected)
  add_library(${library} INTERFACE IMPORTED)
  target_include_directories(${library} INTERFACE ${only_these})
endforeach()
