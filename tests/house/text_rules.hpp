/// House rules that need no more than a file's text.
#pragma once

#include "tests/house/source_tree.hpp"

namespace earthwork::house {

inline constexpr std::size_t kMaxFileLines = 600;
inline constexpr std::size_t kMaxFunctionLines = 70;

/// Sources longer than kMaxFileLines; tables (*_tables.cpp) may be.
Findings check_length(const TextFile& file);

/// Functions of a C++ file longer than kMaxFunctionLines, signature and braces included. Reads
/// the layout that clang-format gives, so it finds functions of namespaces and classes, and takes
/// a lambda for a part of the function around it.
Findings check_functions(const TextFile& file);

/// Words that mark work as unfinished.
Findings check_marks(const TextFile& file);

/// Folders of one machine, and hosts of package registries.
Findings check_places(const TextFile& file);

/// C++ sources that the CMakeLists.txt of their folder does not name: they are not built.
Findings check_listed(const std::vector<TextFile>& files);

/// Lines of C++ and of JavaScript, in tests/ and outside.
struct LineCount {
  std::size_t source = 0, test = 0;
};
LineCount count_lines(const std::vector<TextFile>& files);

}  // namespace earthwork::house
