# The toolchain of the page: Debian's emscripten as CMake knows it, and what it lacks there.
include(/usr/share/emscripten/cmake/Modules/Platform/Emscripten.cmake)

# Its JavaScript optimiser is written for node and does not find Debian's acorn by itself.
set(CMAKE_CXX_LINKER_LAUNCHER ${CMAKE_COMMAND} -E env NODE_PATH=/usr/share/nodejs)
