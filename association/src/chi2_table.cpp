// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/association/chi2_table.hpp"

#include <utility>
#include <vector>

#include "helixnav/core/chi2.hpp"

namespace helixnav::association {
namespace {

constexpr std::size_t remembered_probabilities = 8;

struct Table {
  double probability;
  std::vector<double> threshold_by_dof;  // negative: not asked for yet
};

Table& table_of(double probability) {
  thread_local std::vector<Table> tables;
  for (Table& table : tables) {
    if (table.probability == probability) return table;
  }
  if (tables.size() == remembered_probabilities) tables.erase(tables.begin());
  tables.push_back({probability, {}});
  return tables.back();
}

}  // namespace

double chi2_threshold(double probability, int dof) {
  if (dof < 1) return core::chi2_quantile(probability, dof);  // its error
  std::vector<double>& thresholds = table_of(probability).threshold_by_dof;
  const auto index = static_cast<std::size_t>(dof);
  if (thresholds.size() <= index) thresholds.resize(index + 1, -1.0);
  if (thresholds[index] < 0.0) thresholds[index] = core::chi2_quantile(probability, dof);
  return thresholds[index];
}

}  // namespace helixnav::association
