// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

namespace helixnav::core {

/// The name of a class of objects (a species, the colour of a cone), held in place: no allocation, and the same class
/// in every log and map that spells it the same way.
class ClassName {
 public:
  static constexpr std::size_t most_bytes = 23;

  ClassName() = default;
  /// PreconditionError for a name that is longer than most_bytes.
  explicit ClassName(std::string_view text);

  bool empty() const { return text_.front() == '\0'; }
  std::string_view text() const { return text_.data(); }
  bool operator==(const ClassName& other) const { return text_ == other.text_; }
  bool operator!=(const ClassName& other) const { return text_ != other.text_; }
  bool operator<(const ClassName& other) const { return text_ < other.text_; }

 private:
  std::array<char, most_bytes + 1> text_{};  ///< zeros behind the name
};

/// What a detector reports about an object besides its position. Any of it may be missing.
struct Appearance {
  ClassName name;             ///< of the class; empty: not given
  double class_error = 0.01;  ///< probability that the given class is not the object's, in (0, 1)
  double size_m = 0.0;        ///< diameter, width; 0: not given
  double sigma_size_m = 0.0;

  bool is_given() const { return !name.empty() || size_m > 0.0; }
};

/// What is known about a landmark's appearance from all its observations: ln of the odds for each of a few classes
/// against one that was never given, and a Gaussian for its size.
struct LandmarkAppearance {
  struct Vote {
    ClassName name;     ///< empty: none
    double nats = 0.0;  ///< Σ ln(p(given | is it) / p(given | is not))
  };
  std::array<Vote, 3> votes;  ///< by descending nats; beyond these the least supported are dropped
  double size_m = 0.0;        ///< 0: unknown
  double size_variance_m2 = 0.0;

  bool is_given() const { return !votes.front().name.empty() || size_m > 0.0; }
  void add_vote(const ClassName& name, double nats);
  /// The size measured once more, independently. With probability `says_nothing`, either that measurement or what was known is not of
  /// this object: whichever is less precise, as the square of its variance.
  void add_size(double measured_m, double variance_m2, double says_nothing = 0.0);
};

/// Two that are the same landmark, each from its own observations.
LandmarkAppearance fused(const LandmarkAppearance& one, const LandmarkAppearance& other);

}  // namespace helixnav::core
