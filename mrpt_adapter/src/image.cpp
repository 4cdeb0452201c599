// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <string>

#include <mrpt/img/CImage.h>

#include "helixnav/core/errors.hpp"
#include "map_builder_impl.hpp"
#include "matrices.hpp"

namespace helixnav::mrpt_adapter {
namespace {

using mrpt::img::TColor;

constexpr int longest_side_px = 1000;
constexpr int border_px = 40;

/// Metres to pixels: x to the right, y up, the same scale for both.
class Picture {
 public:
  Picture(const Eigen::Vector2d& low_m, const Eigen::Vector2d& high_m)
      : low_m_(low_m), scale_px_((longest_side_px - 2 * border_px) / (high_m - low_m).maxCoeff()) {
    const Eigen::Vector2d size_px = (high_m - low_m) * scale_px_;
    width_px_ = static_cast<int>(size_px.x()) + 2 * border_px;
    height_px_ = static_cast<int>(size_px.y()) + 2 * border_px;
    image_.resize(static_cast<std::size_t>(width_px_), static_cast<std::size_t>(height_px_), mrpt::img::CH_RGB);
    image_.filledRectangle(0, 0, width_px_ - 1, height_px_ - 1, TColor::white());
  }

  Eigen::Vector2i pixel(const Eigen::Vector2d& point_m) const {
    const Eigen::Vector2d px = (point_m - low_m_) * scale_px_;
    return {border_px + static_cast<int>(px.x()), height_px_ - border_px - static_cast<int>(px.y())};
  }

  void line(const Eigen::Vector2d& from_m, const Eigen::Vector2d& to_m, const TColor& colour, unsigned width = 1) {
    const Eigen::Vector2i from = pixel(from_m);
    const Eigen::Vector2i to = pixel(to_m);
    image_.line(from.x(), from.y(), to.x(), to.y(), colour, width);
  }

  void dot(const Eigen::Vector2d& at_m, int radius_px, const TColor& colour) {
    const Eigen::Vector2i at = pixel(at_m);
    for (int radius = radius_px; radius > 0; --radius) image_.drawCircle(at.x(), at.y(), radius, colour, 2);
  }

  void ellipse(const core::PointGaussian& point, double quantiles, const TColor& colour) {
    // Rows of an image count downwards, which turns the correlation of x and y around.
    Eigen::Matrix2d covariance_px = point.covariance_m2 * scale_px_ * scale_px_;
    covariance_px(0, 1) = covariance_px(1, 0) = -covariance_px(0, 1);
    covariance_px += Eigen::Matrix2d::Identity() * 1e-6;  // MRPT refuses a singular one
    const Eigen::Vector2i at = pixel(point.mean_m);
    image_.ellipseGaussian(mrpt_of(covariance_px), at.x(), at.y(), quantiles, colour, 1, 40);
  }

  bool save(const std::string& file) const { return image_.saveToFile(file); }

 private:
  Eigen::Vector2d low_m_;
  double scale_px_;
  int width_px_ = 0;
  int height_px_ = 0;
  mrpt::img::CImage image_;
};

/// All that is to be seen, with a metre at least.
Picture picture_of(const std::vector<core::MapLandmark>& map, const std::vector<core::Pose2>& path,
                   const core::Pose2& pose) {
  Eigen::Vector2d low_m = pose.position_m();
  Eigen::Vector2d high_m = low_m;
  const auto widen = [&](const Eigen::Vector2d& point_m) {
    low_m = low_m.cwiseMin(point_m);
    high_m = high_m.cwiseMax(point_m);
  };
  for (const core::MapLandmark& landmark : map) widen(landmark.point.mean_m);
  for (const core::Pose2& passed : path) widen(passed.position_m());
  const Eigen::Vector2d at_least_m = (low_m + high_m) / 2.0;
  widen(at_least_m + Eigen::Vector2d(0.5, 0.5));
  widen(at_least_m - Eigen::Vector2d(0.5, 0.5));
  return {low_m, high_m};
}

/// MRPT throws an exception of its own for the name of a format that it does not write.
std::string with_extension(const std::string& file) {
  std::string extension = std::filesystem::path(file).extension().string();
  for (char& letter : extension) letter = static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
  for (const char* known : {".png", ".jpg", ".jpeg", ".bmp"}) {
    if (extension == known) return file;
  }
  return file + ".png";
}

}  // namespace

void MapBuilder::saveCurrentEstimationToImage(const std::string& file, bool /*formatEMF_BMP*/) {
  const Impl::Lock lock(impl_->lock);
  const std::vector<core::MapLandmark> map = impl_->navigator->map();
  const core::PoseGaussian pose = impl_->navigator->pose();
  Picture picture = picture_of(map, impl_->path, pose.mean);
  const TColor blue(40, 90, 200);
  const TColor grey(170, 170, 170);
  const TColor red(220, 50, 30);
  for (std::size_t i = 1; i < impl_->path.size(); ++i) {
    picture.line(impl_->path[i - 1].position_m(), impl_->path[i].position_m(), red);
  }
  for (const core::MapLandmark& landmark : map) {
    const TColor& colour = landmark.state == core::LandmarkState::mature ? blue : grey;
    picture.ellipse(landmark.point, impl_->options.quantiles_3D_representation, colour);
    picture.dot(landmark.point.mean_m, 2, colour);
  }
  const bool searching = impl_->last && impl_->last->mode == core::Mode::searching;
  if (searching) {
    for (const core::Pose2& particle : impl_->last->cloud) picture.dot(particle.position_m(), 1, TColor(230, 140, 0));
  }
  picture.dot(pose.mean.position_m(), 5, red);
  const std::string name = with_extension(file);
  if (!picture.save(name)) throw core::InputError(name + ": the picture cannot be written");
}

}  // namespace helixnav::mrpt_adapter
