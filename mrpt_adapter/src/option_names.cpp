// SPDX-License-Identifier: BSD-3-Clause
#include "option_names.hpp"

#include <charconv>
#include <sstream>

#include "helixnav/core/errors.hpp"
#include "helixnav/fastslam/association_names.hpp"

namespace helixnav::mrpt_adapter {
namespace {

const std::vector<association::Method>& methods() {
  using association::Method;
  static const std::vector<Method> all{
      Method::likelihood_ratio,     Method::joint_likelihood_ratio,   Method::jcbb,
      Method::nearest_neighbour,    Method::nearest_neighbour_unique, Method::ihgr_published,
      Method::ihgr_likelihood_ratio};
  return all;
}

}  // namespace

std::vector<std::string> association_names() {
  std::vector<std::string> names;
  for (const association::Method method : methods()) names.emplace_back(association::name(method));
  return names;
}

std::vector<std::string> detector_names() { return {"trees", "reflectors", "none"}; }

std::vector<std::string> retraction_names() { return {"right-invariant", "standard"}; }

/// Known association is what landmarkIDs make of any of these.
std::vector<std::string> fastslam_association_names() {
  std::vector<std::string> names;
  for (const auto& [name, association] : fastslam::association_names()) {
    if (association != fastslam::Association::known) names.push_back(name);
  }
  return names;
}

fastslam::Association fastslam_association_of(const std::string& name) {
  for (const auto& [its_name, association] : fastslam::association_names()) {
    if (its_name == name && association != fastslam::Association::known) return association;
  }
  throw core::InputError("fastslam_association = \"" + name + "\": there is no such kind of association");
}

association::Method method_of(const std::string& name) {
  for (const association::Method method : methods()) {
    if (association::name(method) == name) return method;
  }
  throw core::InputError("association = \"" + name + "\": there is no such method");
}

cekf::Retraction retraction_of(const std::string& name) {
  if (name == "right-invariant") return cekf::Retraction::right_invariant;
  if (name == "standard") return cekf::Retraction::standard;
  throw core::InputError("retraction = \"" + name + "\": expected right-invariant or standard");
}

std::string short_text(double number) {
  std::ostringstream text;
  text << number;
  return text.str();
}

std::string exact_text(double number) {
  char buffer[32];
  const std::to_chars_result end = std::to_chars(buffer, buffer + sizeof buffer, number);
  return {buffer, end.ptr};
}

}  // namespace helixnav::mrpt_adapter
