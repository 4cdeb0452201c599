// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/smoothing/minimum.hpp"

#include "joint.hpp"
#include "session.hpp"

namespace helixnav::smoothing {

struct Minimum::Solved {
  Solved(const Problem& problem, const Options& given) : options(given), session(problem, options) {}

  Options options;
  Session session;
};

Minimum::Minimum(Problem& problem, const Options& options) {
  check_problem(problem);
  solved_ = std::make_unique<Solved>(problem, options);
  Session& session = solved_->session;
  if (session.layout.columns > 0) {
    session.report.reason = levenberg_marquardt(session);
    session.linearize();
    session.factorize_undamped();  // damping hides what the measurements leave open
  } else {
    session.report.reason = Reason::converged;
  }
  put_state(session.state, problem.graph);
  session.report.chi2 = session.chi2;
}

Minimum::~Minimum() = default;
Minimum::Minimum(Minimum&&) noexcept = default;
Minimum& Minimum::operator=(Minimum&&) noexcept = default;

const Report& Minimum::report() const { return solved_->session.report; }

Eigen::MatrixXd Minimum::joint_covariance(const std::vector<int>& poses, const std::vector<int>& landmarks) const {
  return smoothing::joint_covariance(solved_->session, poses, landmarks);
}

}  // namespace helixnav::smoothing
