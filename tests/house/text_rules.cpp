#include "tests/house/text_rules.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <map>

namespace earthwork::house {
namespace {

// In two parts, so that this file keeps the rules it states.
struct Split {
  std::string_view head, tail;
  std::string whole() const { return std::string(head).append(tail); }
};
constexpr std::array<Split, 4> kMarks = {{{"TO", "DO"}, {"FIX", "ME"}, {"XX", "X"}, {"HA", "CK"}}};
constexpr std::array<Split, 9> kPlaces = {{{"/wo", "rk/"},
                                           {"/fa", "rm/"},
                                           {"/tm", "p/"},
                                           {"/ho", "me/"},
                                           {"/ro", "ot/"},
                                           {".lib", "rary"},
                                           {"registry.npm", "js.org"},
                                           {"registry.yarn", "pkg.com"},
                                           {"deb.deb", "ian.org"}}};

bool is_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

bool holds_word(std::string_view line, std::string_view word) {
  for (std::size_t at = line.find(word); at != std::string_view::npos;
       at = line.find(word, at + 1)) {
    const std::size_t end = at + word.size();
    const bool begins = at == 0 || !is_word(line[at - 1]);
    const bool ends = end == line.size() || !is_word(line[end]);
    if (begins && ends) return true;
  }
  return false;
}

bool is_script(std::string_view path) {
  return path.ends_with(".js") || path.ends_with(".mjs") || path.ends_with(".css");
}

std::size_t indent_of(std::string_view line) {
  return std::min(line.find_first_not_of(' '), line.size());
}

// The first line of a function's signature, which may take several: up to a line that ends in '{'.
bool begins_function(std::string_view line, std::size_t indent) {
  constexpr std::array<std::string_view, 16> others = {
      "namespace", "struct ", "class ", "enum ", "union ", "extern ", "if ", "for ",
      "while ",    "switch ", "do ",    "} ",    "using ", "return ", "#",   "//"};
  if (indent_of(line) != indent || line.size() == indent) return false;
  const std::string_view text = line.substr(indent);
  const bool other = std::any_of(others.begin(), others.end(),
                                 [&](std::string_view word) { return text.starts_with(word); });
  return !other && text.find('(') != std::string_view::npos && !text.ends_with(';');
}

// The line after a function that begins at `begin`, or `begin` when it turns out to be none.
std::size_t end_of_function(const std::vector<std::string_view>& lines, std::size_t begin,
                            std::size_t indent) {
  std::size_t i = begin;
  while (i < lines.size() && !lines[i].ends_with('{')) {
    const bool goes_on = i == begin || indent_of(lines[i]) > indent;
    if (!goes_on || lines[i].ends_with(';') || lines[i].ends_with('}')) return begin;
    ++i;
  }
  for (; i < lines.size(); ++i) {
    if (lines[i].empty() || indent_of(lines[i]) > indent) continue;
    // Less indented: this was a statement that ends in a lambda, inside of what ends here.
    if (indent_of(lines[i]) < indent) return begin;
    if (lines[i].substr(indent).starts_with('}')) break;
  }
  return std::min(i + 1, lines.size());
}

}  // namespace

Findings check_length(const TextFile& file) {
  if (!is_cpp(file.path) && !is_script(file.path)) return {};
  const std::size_t count = lines_of(file.text).size();
  if (count <= kMaxFileLines || file.path.ends_with("_tables.cpp")) return {};
  return {finding(file, count, "longer than " + std::to_string(kMaxFileLines) + " lines")};
}

Findings check_functions(const TextFile& file) {
  if (!is_cpp(file.path)) return {};
  Findings findings;
  const auto lines = lines_of(file.text);
  for (const std::size_t indent : {std::size_t{0}, std::size_t{2}}) {
    for (std::size_t i = 0; i < lines.size(); ++i) {
      if (!begins_function(lines[i], indent)) continue;
      const std::size_t length = end_of_function(lines, i, indent) - i;
      if (length <= kMaxFunctionLines) continue;
      findings.push_back(finding(file, i + 1,
                                 "a function of " + std::to_string(length) + " lines; " +
                                     std::to_string(kMaxFunctionLines) + " is the limit"));
    }
  }
  return findings;
}

Findings check_marks(const TextFile& file) {
  Findings findings;
  for (const Split& mark : kMarks) {
    std::size_t number = 0;
    for (const std::string_view line : lines_of(file.text)) {
      ++number;
      if (!holds_word(line, mark.whole())) continue;
      findings.push_back(finding(file, number, "unfinished: " + mark.whole()));
    }
  }
  return findings;
}

Findings check_places(const TextFile& file) {
  Findings findings;
  for (const Split& place : kPlaces) {
    std::size_t number = 0;
    for (const std::string_view line : lines_of(file.text)) {
      ++number;
      if (line.find(place.whole()) == std::string_view::npos) continue;
      findings.push_back(finding(file, number, "names " + place.whole()));
    }
  }
  return findings;
}

Findings check_listed(const std::vector<TextFile>& files) {
  std::map<std::string_view, const TextFile*> by_path;
  for (const TextFile& file : files) by_path[file.path] = &file;
  Findings findings;
  for (const TextFile& file : files) {
    if (!file.path.ends_with(".cpp")) continue;
    const std::size_t slash = file.path.rfind('/');
    const auto list = by_path.find(file.path.substr(0, slash) + "/CMakeLists.txt");
    const std::string_view name = std::string_view(file.path).substr(slash + 1);
    if (list == by_path.end() || list->second->text.find(name) == std::string::npos) {
      findings.push_back(finding(file, 0, "the CMakeLists.txt beside it does not name it"));
    }
  }
  return findings;
}

LineCount count_lines(const std::vector<TextFile>& files) {
  LineCount count;
  for (const TextFile& file : files) {
    if (!is_cpp(file.path) && !is_script(file.path)) continue;
    (file.path.starts_with("tests/") ? count.test : count.source) += lines_of(file.text).size();
  }
  return count;
}

}  // namespace earthwork::house
