// SPDX-License-Identifier: BSD-3-Clause
#include "text_cursor.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <utility>

#include "helixnav/core/errors.hpp"

namespace helixnav::logs {
namespace {

/// A field in a form fit for a message: printable and short.
std::string quoted(std::string_view field) {
  constexpr std::size_t longest = 24;
  std::string text = "'";
  for (const char c : field.substr(0, longest)) {
    text += c >= ' ' && c <= '~' ? c : '?';
  }
  return text + (field.size() > longest ? "…'" : "'");
}

std::string to_text(double value) {
  std::array<char, 32> buffer{};
  return {buffer.data(), std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr};
}

}  // namespace

TextCursor::TextCursor(std::string_view text, std::string file_name, char separator, Place place)
    : text_(text), file_name_(std::move(file_name)), separator_(separator), place_(place) {}

void TextCursor::skip_blanks() {
  while (position_ < text_.size()) {
    const char c = text_[position_];
    if (c != ' ' && c != '\t' && c != '\r') {
      return;
    }
    ++position_;
  }
}

void TextCursor::skip_line_ends() {
  for (skip_blanks(); position_ < text_.size() && text_[position_] == '\n'; skip_blanks()) {
    ++position_;
    ++line_;
  }
}

bool TextCursor::at_end() {
  skip_line_ends();
  return position_ == text_.size();
}

bool TextCursor::at_line_end() {
  skip_blanks();
  return position_ == text_.size() || text_[position_] == '\n';
}

std::string_view TextCursor::word() {
  skip_blanks();
  const std::size_t begin = position_;
  while (position_ < text_.size()) {
    const char c = text_[position_];
    if (c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == separator_) {
      break;
    }
    ++position_;
  }
  const std::string_view field = text_.substr(begin, position_ - begin);
  skip_blanks();
  if (separator_ != ' ' && position_ < text_.size() && text_[position_] == separator_) {
    ++position_;
  }
  return field;
}

template <class Number>
Number TextCursor::parse(std::string_view what) {
  skip_blanks();
  const std::size_t begin_of_field = position_;
  const std::string_view field = word();
  Number value{};
  const char* begin = field.data();
  const char* end = begin + field.size();
  if (begin != end && *begin == '+') {
    ++begin;
  }
  const auto [stop, error] = std::from_chars(begin, end, value);
  bool good = error == std::errc{} && stop == end;
  if constexpr (std::is_floating_point_v<Number>) {
    good = good && std::isfinite(value);
  }
  if (!good) {
    position_ = begin_of_field;
    fail_expected(what, field);
  }
  return value;
}

double TextCursor::number(std::string_view what) { return parse<double>(what); }
std::int64_t TextCursor::integer(std::string_view what) { return parse<std::int64_t>(what); }

double TextCursor::number_in_stream(std::string_view what) {
  skip_line_ends();
  return parse<double>(what);
}

std::int64_t TextCursor::integer_in_stream(std::string_view what) {
  skip_line_ends();
  return parse<std::int64_t>(what);
}

double TextCursor::number_between(double low, double high, std::string_view what) {
  skip_blanks();
  const std::size_t begin_of_field = position_;
  const double value = parse<double>(what);
  if (value < low || value > high) {
    const std::string_view field = text_.substr(begin_of_field, position_ - begin_of_field);
    position_ = begin_of_field;
    fail_expected(std::string(what) + " (" + to_text(low) + " … " + to_text(high) + ")",
                  field.substr(0, field.find_first_of(" \t\r\n,")));
  }
  return value;
}

double TextCursor::number_between_in_stream(double low, double high, std::string_view what) {
  skip_line_ends();
  return number_between(low, high, what);
}

void TextCursor::end_line(std::string_view columns) {
  if (!at_line_end()) {
    fail("more columns than " + std::string(columns));
  }
  skip_line();
}

void TextCursor::skip_line() {
  const std::size_t end = text_.find('\n', position_);
  position_ = end == std::string_view::npos ? text_.size() : end + 1;
  line_ += end == std::string_view::npos ? 0 : 1;
}

void TextCursor::fail(std::string_view message) const {
  const std::string where = place_ == Place::line ? ":" + std::to_string(line_) : ": byte " + std::to_string(position_);
  throw core::InputError(file_name_ + where + ": " + std::string(message));
}

void TextCursor::fail_expected(std::string_view what, std::string_view found) {
  std::string shown = quoted(found);
  if (found.empty()) {
    const bool more_lines = place_ == Place::line && position_ < text_.size();
    const bool empty_field = separator_ != ' ' && peek() == separator_;
    shown = empty_field ? "an empty field" : more_lines ? "the end of the line" : "the end of the file";
  }
  fail("expected " + std::string(what) + ", found " + shown);
}

}  // namespace helixnav::logs
