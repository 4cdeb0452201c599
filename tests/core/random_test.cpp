// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/core/random.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

namespace helixnav::core {
namespace {

// Seeds are fixed, so that a test that passes always passes. Bounds are such that a correct generator with a new seed
// would fail one of them with the probability given.
constexpr int draws = 100000;
constexpr double five_sigma = 5.0;             // two-sided false alarm 6e-7
constexpr double kolmogorov_at_1e_6 = 2.6936;  // sqrt(n)·D is beyond it with probability 2·exp(−2·2.6936²) = 1e-6

double kolmogorov_smirnov(std::vector<double> sample, const std::function<double(double)>& cdf) {
  std::sort(sample.begin(), sample.end());
  const auto n = static_cast<double>(sample.size());
  double distance = 0.0;
  for (std::size_t i = 0; i < sample.size(); ++i) {
    const double F = cdf(sample[i]);
    const auto k = static_cast<double>(i);
    distance = std::max({distance, F - k / n, (k + 1.0) / n - F});
  }
  return std::sqrt(n) * distance;
}

template <class Draw>
std::vector<double> sample_of(int n, const Draw& draw) {
  std::vector<double> sample(static_cast<std::size_t>(n));
  for (double& x : sample) x = draw();
  return sample;
}

double mean_of(const std::vector<double>& v) {
  double sum = 0.0;
  for (const double x : v) sum += x;
  return sum / static_cast<double>(v.size());
}

double correlation(const std::vector<double>& a, const std::vector<double>& b) {
  const Eigen::Map<const Eigen::ArrayXd> x(a.data(), static_cast<Eigen::Index>(a.size()));
  const Eigen::Map<const Eigen::ArrayXd> y(b.data(), static_cast<Eigen::Index>(b.size()));
  const Eigen::ArrayXd dx = x - x.mean(), dy = y - y.mean();
  return (dx * dy).sum() / std::sqrt(dx.square().sum() * dy.square().sum());
}

TEST(RandomStream, RepeatsItselfForTheSameSeedAndName) {
  RandomStream a(42, "odometry"), b(42, "odometry");
  for (int i = 0; i < 1000; ++i) EXPECT_EQ(a.bits(), b.bits());
}

// Recorded once. A different value on another platform or after a library change breaks "same seed, same bytes".
TEST(RandomStream, GivesTheGoldenValues) {
  RandomStream random(2003, "golden");
  EXPECT_EQ(random.bits(), 15670032540107168516ULL);
  EXPECT_EQ(random.uniform(), 0.22882794524724176);
  EXPECT_EQ(random.below(1000), 535U);
  EXPECT_DOUBLE_EQ(random.normal(), 0.27879912921301492);
  EXPECT_EQ(random.poisson(3.5), 4);
  EXPECT_EQ(random.poisson(100.0), 90);
  EXPECT_EQ(random.bits(), 4655086229519290619ULL);
}

TEST(RandomStream, UniformIsUniform) {
  RandomStream random(1, "uniform");
  const std::vector<double> sample = sample_of(draws, [&] { return random.uniform(-2.0, 6.0); });
  EXPECT_GE(*std::min_element(sample.begin(), sample.end()), -2.0);
  EXPECT_LT(*std::max_element(sample.begin(), sample.end()), 6.0);
  EXPECT_LT(kolmogorov_smirnov(sample, [](double x) { return (x + 2.0) / 8.0; }), kolmogorov_at_1e_6);
}

TEST(RandomStream, NormalIsNormal) {
  RandomStream random(2, "normal");
  const std::vector<double> sample = sample_of(draws, [&] { return random.normal(3.0, 2.0); });
  const auto cdf = [](double x) { return 0.5 * std::erfc(-(x - 3.0) / (2.0 * std::sqrt(2.0))); };
  EXPECT_LT(kolmogorov_smirnov(sample, cdf), kolmogorov_at_1e_6);
  // Moments: the mean of z^k over n draws has the standard deviation sqrt((E z^2k − (E z^k)²) / n).
  const auto moment = [&](int k) {
    double sum = 0.0;
    for (const double x : sample) sum += std::pow((x - 3.0) / 2.0, k);
    return sum / draws;
  };
  EXPECT_NEAR(moment(1), 0.0, five_sigma * std::sqrt(1.0 / draws));
  EXPECT_NEAR(moment(2), 1.0, five_sigma * std::sqrt(2.0 / draws));
  EXPECT_NEAR(moment(3), 0.0, five_sigma * std::sqrt(15.0 / draws));
  EXPECT_NEAR(moment(4), 3.0, five_sigma * std::sqrt(96.0 / draws));
}

TEST(RandomStream, PoissonHasItsMeanAndVarianceOnBothOfItsAlgorithms) {
  RandomStream random(3, "poisson");
  for (const double mean : {0.5, 3.0, 9.9, 10.1, 80.0, 500.0}) {
    const std::vector<double> sample = sample_of(draws, [&] { return random.poisson(mean); });
    EXPECT_NEAR(mean_of(sample), mean, five_sigma * std::sqrt(mean / draws)) << mean;
    std::vector<double> squares;
    for (const double x : sample) squares.push_back((x - mean) * (x - mean));
    // Var (x−µ)² = µ + 2µ² for a Poisson variable.
    EXPECT_NEAR(mean_of(squares), mean, five_sigma * std::sqrt((mean + 2.0 * mean * mean) / draws)) << mean;
  }
  EXPECT_EQ(random.poisson(0.0), 0);
}

TEST(RandomStream, BelowIsUniformOverTheIntegers) {
  RandomStream random(4, "below");
  std::vector<int> counts(7, 0);
  for (int i = 0; i < draws; ++i) ++counts.at(static_cast<std::size_t>(random.below(7)));
  double chi2 = 0.0;
  const double expected = draws / 7.0;
  for (const int count : counts) chi2 += (count - expected) * (count - expected) / expected;
  EXPECT_LT(chi2, 38.26);  // beyond it with probability 1e-6 at 6 degrees of freedom
  EXPECT_EQ(random.below(1), 0U);
}

TEST(RandomStream, BernoulliHasItsShare) {
  RandomStream random(5, "bernoulli");
  for (const double p : {0.01, 0.5, 0.9}) {
    const std::vector<double> sample = sample_of(draws, [&] { return random.bernoulli(p) ? 1.0 : 0.0; });
    EXPECT_NEAR(mean_of(sample), p, five_sigma * std::sqrt(p * (1.0 - p) / draws)) << p;
  }
  EXPECT_FALSE(random.bernoulli(0.0));
  EXPECT_TRUE(random.bernoulli(1.0));
}

TEST(RandomStream, Normal3HasItsCovarianceAlsoWhenThatIsSingular) {
  RandomStream random(6, "normal3");
  Eigen::Matrix<double, 3, 2> J;
  J << 1.0, 0.2, -0.4, 2.0, 0.1, 0.3;
  const Eigen::Matrix3d covariance = J * J.transpose();
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  const Eigen::Vector3d out = J.col(0).cross(J.col(1)).normalized();
  double largest_out = 0.0;
  for (int i = 0; i < draws; ++i) {
    const Eigen::Vector3d x = random.normal3(covariance);
    sum += x * x.transpose();
    largest_out = std::max(largest_out, std::abs(out.dot(x)));
  }
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const double variance = covariance(i, i) * covariance(j, j) + covariance(i, j) * covariance(i, j);
      EXPECT_NEAR(sum(i, j) / draws, covariance(i, j), five_sigma * std::sqrt(variance / draws)) << i << j;
    }
  }
  EXPECT_LT(largest_out, 1e-6);  // nothing leaves the plane
}

TEST(RandomStream, StreamsOfOtherNamesOrSeedsAreUncorrelated) {
  const auto normals = [](std::uint64_t seed, const char* name) {
    RandomStream random(seed, name);
    return sample_of(draws, [&] { return random.normal(); });
  };
  const std::vector<double> a = normals(7, "odometry");
  for (const std::vector<double>& b : {normals(7, "scanner"), normals(7, "odometrz"), normals(7, ""),
                                       normals(8, "odometry"), normals(7 + (1ULL << 32), "odometry")}) {
    EXPECT_NE(a.front(), b.front());
    EXPECT_LT(std::abs(correlation(a, b)), five_sigma / std::sqrt(draws));
  }
}

TEST(RandomStream, FirstDrawsOfNeighbouringSeedsAreUniform) {
  std::uint64_t seed = 0;
  const std::vector<double> sample = sample_of(5000, [&] { return RandomStream(seed++, "first").uniform(); });
  EXPECT_LT(kolmogorov_smirnov(sample, [](double x) { return x; }), kolmogorov_at_1e_6);
  const std::vector<double> next(sample.begin() + 1, sample.end());
  EXPECT_LT(std::abs(correlation({sample.begin(), sample.end() - 1}, next)), five_sigma / std::sqrt(5000.0));
}

}  // namespace
}  // namespace helixnav::core
