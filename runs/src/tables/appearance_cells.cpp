// SPDX-License-Identifier: BSD-3-Clause
#include "appearance_cells.hpp"

#include <cmath>
#include <string_view>

#include "helixnav/files/number_text.hpp"

namespace helixnav::runs {

void append_appearance(std::string& text, const core::LandmarkAppearance& known) {
  const core::LandmarkAppearance::Vote& vote = known.votes.front();
  text += ',';
  text += vote.name.text();
  text += ',';
  if (!vote.name.empty()) files::append_number(text, vote.nats);
  text += ',';
  if (known.size_m > 0.0) files::append_number(text, known.size_m);
  text += ',';
  if (known.size_m > 0.0) files::append_number(text, std::sqrt(known.size_variance_m2));
}

core::LandmarkAppearance read_appearance(const RunRow& row, std::size_t column) {
  core::LandmarkAppearance known;
  const std::string_view name = row.text(column);
  if (name.size() > core::ClassName::most_bytes) {
    row.refuse(column, "at most " + std::to_string(core::ClassName::most_bytes) + " bytes");
  }
  if (!name.empty()) {
    if (!(row.finite(column + 1) >= 0.0)) row.refuse(column + 1, "a number from 0");
    known.votes.front() = {core::ClassName(name), row.finite(column + 1)};
  }
  if (row.text(column + 2).empty()) return known;
  known.size_m = row.finite(column + 2);
  known.size_variance_m2 = row.finite(column + 3) * row.finite(column + 3);
  if (!(known.size_m > 0.0)) row.refuse(column + 2, "a size above 0");
  if (!(known.size_variance_m2 > 0.0)) row.refuse(column + 3, "a standard deviation above 0");
  return known;
}

}  // namespace helixnav::runs
