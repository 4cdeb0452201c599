// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace helixnav::logs {

/// Walks through a text of fields and returns numbers, with errors that name file, line or byte, what was found and
/// what was expected (core::InputError). Spaces, tabs and one kind of separator (a comma, or another space) separate
/// the fields; "\r\n" ends a line like "\n". The text outlives the cursor. Numbers by std::from_chars: no locale, no
/// allocation.
class TextCursor {
 public:
  /// How an error names a place: by line if a text has lines, by byte if everything is on one.
  enum class Place { line, byte };

  TextCursor(std::string_view text, std::string file_name, char separator = ' ', Place place = Place::line);

  /// True when nothing but separators and line ends is left; moves past them.
  bool at_end();
  /// True when no field is left in this line; moves past spaces.
  bool at_line_end();

  /// The next character, '\0' at the end of the text.
  char peek() const { return position_ < text_.size() ? text_[position_] : '\0'; }

  /// Next field of this line as a finite number; `what` names it in errors, with its unit.
  double number(std::string_view what);
  std::int64_t integer(std::string_view what);
  /// Next field of this line unchanged, empty at the end of the line.
  std::string_view word();
  /// As number() and integer(), but moves over line ends before the field.
  double number_in_stream(std::string_view what);
  std::int64_t integer_in_stream(std::string_view what);

  /// Moves to the next line; InputError when the current one has fields left (`columns` says how many there should be).
  void end_line(std::string_view columns);
  void skip_line();

  /// As number() and number_in_stream(), but in [low, high].
  double number_between(double low, double high, std::string_view what);
  double number_between_in_stream(double low, double high, std::string_view what);

  /// Throws InputError with the cursor's place: "file:line: message" or "file: byte n: message".
  [[noreturn]] void fail(std::string_view message) const;

  std::size_t line() const { return line_; }

 private:
  template <class Number>
  Number parse(std::string_view what);
  [[noreturn]] void fail_expected(std::string_view what, std::string_view found);
  void skip_blanks();
  void skip_line_ends();

  std::string_view text_;
  std::string file_name_;
  char separator_;
  Place place_;
  std::size_t position_ = 0;
  std::size_t line_ = 1;
};

/// Calls read_row(cursor) on each line that is neither empty nor a comment; `columns` as for end_line().
template <class ReadRow>
void for_each_row(TextCursor& cursor, std::string_view columns, const ReadRow& read_row) {
  while (!cursor.at_end()) {
    if (cursor.peek() == '#') {
      cursor.skip_line();
      continue;
    }
    read_row(cursor);
    cursor.end_line(columns);
  }
}

}  // namespace helixnav::logs
