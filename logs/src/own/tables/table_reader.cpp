// SPDX-License-Identifier: BSD-3-Clause
#include "table_reader.hpp"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>

#include "helixnav/core/errors.hpp"

namespace helixnav::logs {
namespace {

constexpr std::size_t block_bytes = 1 << 20;
constexpr std::size_t longest_line_bytes = 1 << 24;

std::string_view trimmed(std::string_view text, std::size_t& column) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) {
    text.remove_prefix(1);
    ++column;
  }
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
  return text;
}

/// Outside quotes.
std::size_t count_of(char separator, std::string_view line) {
  std::size_t count = 0;
  bool quoted = false;
  for (const char c : line) {
    if (c == '"') quoted = !quoted;
    if (c == separator && !quoted) ++count;
  }
  return count;
}

char separator_of(std::string_view header) {
  char best = ',';
  for (const char separator : {';', '\t'}) {
    if (count_of(separator, header) > count_of(best, header)) best = separator;
  }
  return best;
}

bool begins_with_number(const std::string& cell) {
  const std::size_t sign = !cell.empty() && (cell[0] == '-' || cell[0] == '+' || cell[0] == '.') ? 1 : 0;
  return cell.size() > sign && std::isdigit(static_cast<unsigned char>(cell[sign])) != 0;
}

}  // namespace

void fail_at(const std::string& path, std::size_t line, std::size_t column, const std::string& message) {
  throw PlacedInputError(path, line, column, message);
}

LineReader::LineReader(const std::filesystem::path& path) : file_(path, std::ios::binary) {
  if (!file_ || std::filesystem::is_directory(path)) {
    throw core::InputError(path.string() + ": expected a file that can be read, found: " +
                           (std::filesystem::is_directory(path) ? "a folder" : std::strerror(errno)));
  }
  fill();
  if (buffer_.compare(0, 3, "\xEF\xBB\xBF") == 0) begin_ = 3;
}

bool LineReader::fill() {
  buffer_.erase(0, begin_);
  begin_ = 0;
  const std::size_t kept = buffer_.size();
  buffer_.resize(kept + block_bytes);
  file_.read(buffer_.data() + kept, static_cast<std::streamsize>(block_bytes));
  buffer_.resize(kept + static_cast<std::size_t>(std::max<std::streamsize>(0, file_.gcount())));
  return buffer_.size() != kept;
}

bool LineReader::next(std::string_view& line) {
  std::size_t end = buffer_.find('\n', begin_);
  while (end == std::string::npos && buffer_.size() - begin_ < longest_line_bytes && fill()) {
    end = buffer_.find('\n', begin_);
  }
  if (end == std::string::npos && begin_ == buffer_.size()) return false;
  const std::size_t stop = end == std::string::npos ? buffer_.size() : end;
  line = std::string_view(buffer_).substr(begin_, stop - begin_);
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  begin_ = end == std::string::npos ? stop : stop + 1;
  ++number_;
  return true;
}

TableReader::TableReader(const std::filesystem::path& path) : path_(path.string()), lines_(path) {
  std::string_view line;
  if (!next_line(line)) throw core::InputError(path_ + ":1:1: expected a line that names the columns, found nothing");
  separator_ = separator_of(line);
  header_line_ = lines_.line_number();
  std::vector<Cell> cells;
  split(line, cells);
  for (const Cell& cell : cells) {
    header_.emplace_back(cell.text);
    header_columns_.push_back(cell.column);
  }
  const bool numbers = std::all_of(header_.begin(), header_.end(), begins_with_number);
  if (numbers) fail_at(path_, header_line_, 1, "expected a line that names the columns, found numbers");
}

bool TableReader::next_line(std::string_view& line) {
  while (lines_.next(line)) {
    const std::size_t first = line.find_first_not_of(" \t");
    if (first != std::string_view::npos && line[first] != '#') return true;
  }
  return false;
}

bool TableReader::next(std::vector<Cell>& cells) {
  std::string_view line;
  if (!next_line(line)) return false;
  split(line, cells);
  if (cells.size() != header_.size()) {
    const std::size_t column = cells.size() > header_.size() ? cells[header_.size()].column : line.size() + 1;
    fail_at(path_, lines_.line_number(), column,
            "expected " + std::to_string(header_.size()) + " cells as in the first line, found " +
                std::to_string(cells.size()));
  }
  return true;
}

void TableReader::split(std::string_view line, std::vector<Cell>& cells) {
  cells.clear();
  unquoted_.clear();
  unquoted_.reserve(static_cast<std::size_t>(std::count(line.begin(), line.end(), '"')) / 2);
  std::size_t at = 0;
  for (;;) {
    std::size_t column = at + 1;
    std::size_t first = at;
    while (first < line.size() && line[first] == ' ') ++first;
    if (first < line.size() && line[first] == '"') {
      at = first;
      const std::string_view text = quoted_cell(line, at);
      cells.push_back({trimmed(text, column), first + 1});
    } else {
      const std::size_t end = std::min(line.find(separator_, at), line.size());
      const std::string_view text = trimmed(line.substr(at, end - at), column);
      cells.push_back({text, column});
      at = end;
    }
    if (at >= line.size()) return;
    ++at;  // past the separator
  }
}

/// From its opening quote at `at`, which moves to the separator or the end of the line behind it.
std::string_view TableReader::quoted_cell(std::string_view line, std::size_t& at) {
  const std::size_t begin = at;
  std::string& text = unquoted_.emplace_back();
  for (++at; at < line.size(); ++at) {
    if (line[at] != '"') {
      text += line[at];
    } else if (at + 1 < line.size() && line[at + 1] == '"') {
      text += line[at++];
    } else {
      break;
    }
  }
  if (at >= line.size()) fail_at(path_, lines_.line_number(), begin + 1, "the quote that opens here is not closed");
  ++at;
  while (at < line.size() && line[at] == ' ') ++at;
  if (at < line.size() && line[at] != separator_) {
    fail_at(path_, lines_.line_number(), at + 1, "expected a separator behind the closing quote");
  }
  return text;
}

}  // namespace helixnav::logs
