#include "tests/transcripts/transcript.hpp"

#include <sstream>
#include <stdexcept>

namespace earthwork::transcripts {
namespace {

using Kind = Line::Kind;

struct Word {
  std::string_view start;
  Kind kind;
};
constexpr Word kDirectives[] = {
    {"map ", Kind::map}, {"show ", Kind::show}, {"stop", Kind::stop}, {"#", Kind::note}};
constexpr Word kClientWords[] = {
    {">hex ", Kind::send_hex}, {">close", Kind::close}, {"> ", Kind::send}, {"< ", Kind::receive}};

Line read_line(const std::string& text) {
  if (text.empty()) return {.kind = Kind::note, .client = 0, .text = {}};
  for (const Word& word : kDirectives)
    if (text.starts_with(word.start))
      return {.kind = word.kind,
              .client = 0,
              .text = word.kind == Kind::note ? text : text.substr(word.start.size())};
  if (text[0] >= 'A' && text[0] <= 'Z')
    for (const Word& word : kClientWords)
      if (std::string_view(text).substr(1).starts_with(word.start))
        return {.kind = word.kind, .client = text[0], .text = text.substr(1 + word.start.size())};
  throw std::runtime_error("is no line of a transcript: " + text);
}

std::string written(const Line& line) {
  for (const Word& word : kDirectives)
    if (word.kind == line.kind)
      return line.kind == Kind::note ? line.text : std::string(word.start) + line.text;
  for (const Word& word : kClientWords)
    if (word.kind == line.kind) return line.client + std::string(word.start) + line.text;
  return {};
}

std::string macro(std::string_view name, int count) {
  std::string out;
  if (name == "spaces") return std::string(static_cast<std::size_t>(count), ' ');
  if (name == "nest")
    return std::string(static_cast<std::size_t>(count), '[') +
           std::string(static_cast<std::size_t>(count), ']');
  if (name != "path") throw std::runtime_error("is no macro: $" + std::string(name));
  for (int i = 0; i < count; ++i) out += i == 0 ? "[[0.5,0.5]" : ",[0.5,0.5]";
  return out + "]";
}

}  // namespace

Transcript parse(std::string_view text) {
  Transcript out;
  std::istringstream in{std::string(text)};
  for (std::string line; std::getline(in, line);) {
    try {
      out.lines.push_back(read_line(line));
    } catch (const std::runtime_error& error) {
      throw std::runtime_error("line " + std::to_string(out.lines.size() + 1) + " " + error.what());
    }
  }
  return out;
}

std::string write(const Transcript& transcript) {
  std::string out;
  for (const Line& line : transcript.lines) out += written(line) + "\n";
  return out;
}

std::string expand(std::string text) {
  for (auto open = text.find('('); open != std::string::npos; open = text.find('(', open + 1)) {
    const auto dollar = text.rfind('$', open), close = text.find(')', open);
    if (dollar == std::string::npos || close == std::string::npos) continue;
    const std::string name = text.substr(dollar + 1, open - dollar - 1);
    const std::string made = macro(name, std::stoi(text.substr(open + 1, close - open - 1)));
    text.replace(dollar, close + 1 - dollar, made);
    open = dollar + made.size() - 1;
  }
  return text;
}

}  // namespace earthwork::transcripts
