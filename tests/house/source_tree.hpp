/// The project's own text files, as the house rules read them.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace earthwork::house {

/// `path` starts at the project's root and uses '/'.
struct TextFile {
  std::string path;
  std::string text;
};

/// "path:line: what is wrong", one a finding; empty is good.
using Findings = std::vector<std::string>;

/// All text files below `root` that belong to the project, by path: not what is built, installed,
/// served or hidden from git, and no file that holds a zero byte.
std::vector<TextFile> read_tree(const std::filesystem::path& root);

/// The lines of `text` without their ends.
std::vector<std::string_view> lines_of(std::string_view text);

/// "path:line: message" with lines counted from 1; line 0 stands for the file as a whole.
std::string finding(const TextFile& file, std::size_t line, std::string_view message);

/// C++ sources and headers.
bool is_cpp(std::string_view path);

}  // namespace earthwork::house
