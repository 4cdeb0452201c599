// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "helixnav/core/landmark_id.hpp"
#include "helixnav/core/se2.hpp"

namespace helixnav::core {

/// A search begins: a revisited landmark is too ambiguous to be associated scan by scan. The figures are those of the
/// return with the most expected confusers (supervisor/revisit_ambiguity).
struct TriggerDecision {
  LandmarkId landmark = no_landmark;
  double expected_confusers = 0.0;
  int neighbours = 0;      ///< other old landmarks that the observation may be
  double gate_area = 0.0;  ///< in the units of the observation
  double pose_sigma_m = 0.0;
  double heading_sigma_deg = 0.0;
  int old_in_gate = 0;
};

/// The integrity monitor found the pose wrong: old landmarks were missing while new ones spawned. The navigator rolls
/// back to the trusted checkpoint, begins a search there and reprocesses the drive since then.
struct RollbackDecision {
  int missing = 0;    ///< landmarks revisited, looked for and not seen
  int seen = 0;       ///< landmarks revisited and mostly seen
  int spawned = 0;    ///< landmarks matured since the checkpoint
  double nats = 0.0;  ///< log-likelihood ratio of "pose wrong" against "pose right"
  int scans = 0;      ///< processed again
};

/// The vehicle slipped: it is not where its odometry says. Figures in nats: by how much the slip explains the scan better
/// than the alternative named at each (supervisor/slip_decision).
struct SlipDecision {
  int pairs = 0;                 ///< of observation and landmark that support it
  double nats = 0.0;             ///< than no slip, with new landmarks where the pattern of the map has them
  double pattern_nats = 0.0;     ///< what that pattern takes from `nats`
  double same_pairs_nats = 0.0;  ///< than the same pairs without a slip
  double rival_nats = 0.0;       ///< than a slip to the best other place; than chance where there is none
  double moved_m = 0.0;
  double turned_deg = 0.0;
  double sigma_m = 0.0;  ///< by which the pose was widened
};

/// Everything that was in view vanished from one scan to the next and stayed away: the vehicle slipped, and where to is not clear
/// from one scan. A search began (supervisor/vanished).
struct LostBySlipDecision {
  int missing = 0;       ///< landmarks that the scan before matched and that should still be in view
  int seen = 0;          ///< matched again
  int unknown = 0;       ///< new landmarks instead
  double nats = 0.0;     ///< log-likelihood ratio of "slipped" against "not slipped"
  double sigma_m = 0.0;  ///< by which the pose was widened
};

/// Something that moves had been taken for landmarks: they were dropped (supervisor/moving_things).
struct MovingDecision {
  int landmarks = 0;       ///< dropped
  double nats = 0.0;       ///< log-likelihood ratio of "it moves" against "it stands"
  double speed_mps = 0.0;  ///< over the ground, when it was detected
};

/// Odometry or detections err throughout the drive, and that was taken out of them (supervisor/systematic_errors.hpp has the
/// same quantities). Totals since the beginning of the drive.
struct SystematicDecision {
  double too_long = 0.0;        ///< odometry's distances, as a share of the true ones
  double turn_rad_per_s = 0.0;  ///< odometry turns too far to the left
  double turn_rad_per_m = 0.0;  ///< likewise, per metre forwards
  double heading_rad = 0.0;     ///< sensors point farther to the left than stated
  double short_m = 0.0;         ///< missing from every range
  double nats = 0.0;  ///< by which what was added now explains the drive better than what was taken out before
  int stretches = 0;  ///< of the drive that it was found in, one reach of the sensor long
  int solved_again =
      1;  ///< 1: the drive until now was, without them; 0: not as a whole, and they are taken out from now on
};

/// The drive has shown other noise than was stated, and what was driven before was solved again with it, if it could be. Standard
/// deviations in units of those stated; more than 1: worse than stated. docs/noise.md.
struct NoiseDecision {
  double odometry = 1.0;
  double detections = 1.0;
  double fixes = 1.0;    ///< that err alike, or by more than stated
  int solved_again = 0;  ///< 1: the drive until now was; 0: it could not be, and the noise holds from now on
};

/// An attempt of a search began: particles drawn on helices around old landmarks.
struct AttemptStarted {
  int attempt = 0;
  int reference_landmarks = 0;
  int helix_pairs = 0;
  double log_evidence = 0.0;
};

/// An attempt of a search ended without a closing.
struct AttemptEnded {
  enum class Reason {
    timed_out,     ///< no single mode in time
    nothing_here,  ///< "all of it is new" explains the scans better
    abandoned,     ///< driven too far without passing the constellation test
    outdone,       ///< another pose explains the constellation better than the particles'
  };
  Reason reason = Reason::timed_out;
  int attempt = 0;
  int scans = 0;
  double log_evidence = 0.0;
  double largest_mode = 0.0;  ///< its share of the particles' weight
  double driven_m = 0.0;
};

/// An attempt could not begin: the old landmarks' joint covariance gives no reference map.
struct ReferenceUnusable {
  int attempt = 0;
  int reference_landmarks = 0;
  double least_eigenvalue = 0.0;  ///< of that covariance in the frame of the reference map
};

/// The constellation test of a pose: new landmarks against old ones.
struct VerificationDecision {
  enum class Verdict { accepted, too_few_matches, ratio_too_low, rival_too_good };
  Verdict verdict = Verdict::too_few_matches;
  int matched = 0;
  int unmatched_branch = 0;
  int unmatched_old = 0;
  double ratio = 0.0;
  int rival_matched = 0;
  double rival_ratio = 0.0;
  double rival_share = 0.0;  ///< of the winner's ratio
  int rivals_tried = 0;
  bool adopted = false;  ///< the winner is not the particle filter's hypothesis
  Pose2 T_world_winner;
  Pose2 T_world_rival;
};

/// Several places explain the constellation around the vehicle, and the shape of all that was mapped since the search began
/// belongs to one of them alone. Two in a row, and the map is closed there (supervisor/shape_evidence).
struct ShapeDecision {
  int place = 0;      ///< of those tried, the best constellation first
  int places = 0;     ///< tried
  int pairs = 0;      ///< of landmarks, along all that was mapped
  int alone = 0;      ///< new landmarks without a partner on ground that was mapped before
  double chi2 = 0.0;  ///< of the pairs with dof, if what was mapped may be moved and turned as a whole
  int dof = 0;
  int rival_pairs = 0;  ///< likewise at the other place that explains most
  int rival_alone = 0;
  double rival_chi2 = 0.0;
  int rival_dof = 0;
};

/// The map was closed by pairs of landmarks, or was not because the cost was too high.
struct ClosureDecision {
  bool accepted = false;
  int pairs = 0;
  int dropped = 0;  ///< pairs dropped because of their cost
  int merged = 0;
  double cost = 0.0;  ///< J, χ² with dof
  int dof = 0;        ///< 0 and refused: the map was too uncertain for the cost to be computed
  double limit = 0.0;
  double driven_m = 0.0;  ///< since the search began
  double moved_m = 0.0;   ///< by how much the closing moved the pose
};

/// A search was given up: mapping continues, the loop stays open.
struct UndecidedDecision {
  double driven_m = 0.0;  ///< since the search began
};

/// A search found that the vehicle is not on old ground: the landmarks mapped lately fit nowhere on it, and they are so
/// many that they should.
struct NewGroundDecision {
  double driven_m = 0.0;  ///< since the search began
  int landmarks = 0;      ///< asked with
};

/// The whole drive was solved by least squares after a closing, on its atlas.
struct SmoothingDecision {
  bool accepted = false;
  double chi2 = 0.0;     ///< at the solution
  double limit = 0.0;    ///< that it must not exceed
  int poses = 0;         ///< where phases of the drive end
  int iterations = 0;    ///< fronts of the atlas that were eliminated
  double moved_m = 0.0;  ///< by which the vehicle's position changed
};

/// An absolute fix passed its gate or did not.
struct FixDecision {
  bool accepted = false;
  double nis = 0.0;
  double gate = 0.0;
  Eigen::Vector2d position_world_m = Eigen::Vector2d::Zero();
  double pose_sigma_m = 0.0;  ///< after it
  double widened = 1.0;       ///< covariance it was used with, in units of the one it stated: fixes err alike
};

/// The vehicle was carried: an event reported it (core::Lost), or after a pause what had been in view was gone. The
/// drive continues as a new part, with a map of its own, and its place on the earlier parts is sought (PlacedDecision).
/// Part 0 is what the drive began on; where that was sought on an earlier map, part 0 is that map and the drive began
/// as part 1.
struct CarriedDecision {
  enum class Cause {
    told,         ///< an event reported it
    found_out,    ///< by the scan after a pause: missing to elsewhere_nats
    broken_off,   ///< it was not carried: the part that ends cannot be computed any further
    by_place,     ///< landmarks mapped since a pause are elsewhere on the map: it was carried then
    no_odometry,  ///< it may not have been carried: odometry leaves open which way it turned since the scan before
    wrong_start,  ///< it was not carried: on the map, what is seen does not fit the start that was given
    wrong_place,  ///< it was not carried: the place found on another map is wrong, and the part is placed again
  };
  int part = 0;           ///< that begins with this scan
  int from_part = 0;      ///< that ends
  int landmarks = 0;      ///< of the part that ends, kept as a map of its own
  int dropped = 0;        ///< of it: tentative ones, and those of a map that is too small or too large to be kept
  int apart = 0;          ///< parts whose pose relative to the one that begins is unknown
  double driven_m = 0.0;  ///< in the part that ends
  Cause cause = Cause::told;
  int missing = 0;                 ///< landmarks that were in view before the pause and were not after it
  int seen = 0;                    ///< those that were after it, too
  int unknown = 0;                 ///< observations after it of something else
  double elsewhere_nats = 0.0;     ///< ln of how much likelier all these are anywhere than where it stopped
  double pose_sigma_m = 0.0;       ///< where it is broken off, or of the motion since the scan before
  double heading_sigma_deg = 0.0;  ///< likewise
  int scans = 0;                   ///< before this one, that are of the part that begins
};

/// The session and the map of an earlier one: whether, where and by which evidence the one was found in the other. A
/// row is one answer; for `sought`, how many landmarks were around the vehicle before the first question, whenever more
/// than ever.
struct PlacedDecision {
  enum class Verdict {
    sought,     ///< the place is unknown: the session maps on its own and asks
    accepted,   ///< found: from here on one map, in the frame of the earlier one
    ambiguous,  ///< a place fits, and so may others
    refused,    ///< the best place, but its landmarks contradict each other
    not_here,   ///< no place fits better than chance would
  };
  Verdict verdict = Verdict::sought;
  int earlier_landmarks = 0;
  int questions = 0;      ///< asked so far
  int landmarks = 0;      ///< of the question
  int pairs = 0;          ///< of the best place
  double evidence = 0.0;  ///< ln of the likelihood of that place against chance
  double lead = 0.0;      ///< over its best rival, see relocalize::Answer::gap
  double needed = 0.0;    ///< of evidence and lead each
  int merged = 0;
  double cost = 0.0;  ///< χ² of the pairs with dof, where the maps were joined or would have been
  int dof = 0;
  double limit = 0.0;
  double driven_m = 0.0;  ///< by this session
  Pose2 T_map_session;    ///< of the best place
  int part = 0;           ///< of the drive on which it is, see CarriedDecision
};

/// The whole map was asked where the vehicle is, without the prior: by a search whose prior contains no place or whose
/// odometry rules out the one that was found, or on ground that seems new. Figures of the place as in PlacedDecision.
struct WholeMapDecision {
  enum class Verdict {
    accepted,   ///< found, and the map was closed there
    ambiguous,  ///< a place fits, and so may others
    refused,    ///< the best place, but its landmarks contradict each other
    not_here,   ///< no place fits better than chance would
  };
  Verdict verdict = Verdict::not_here;
  int old_landmarks = 0;
  int questions = 0;  ///< asked so far
  int landmarks = 0;  ///< of the question
  int pairs = 0;
  double evidence = 0.0;
  double lead = 0.0;
  double needed = 0.0;
  double cost = 0.0;  ///< χ² of the pairs with dof and with the motion as it was measured
  int dof = 0;
  double limit = 0.0;
  double odometry_factor =
      1.0;              ///< on the covariance of the motion since the old landmarks were left; 0: the drive was cut
  double loop_m = 0.0;  ///< length of that motion
  double displaced_m = 0.0;  ///< from where odometry has the vehicle
};

/// Work that was left out or put off, because a budget of it was spent or because the mathematics failed. Budgets are counts and
/// never times: the same input gives the same bytes on any machine.
struct PostponedDecision {
  enum class Work {
    association,  ///< the search for the best association was ended: the best found, not proven the best
    window,       ///< the filter holds `size` landmarks, and the hand-over to a part of the map failed
    drive,        ///< the drive of `size` scans and fixes was not solved as a whole after a closing
  };
  Work work = Work::association;
  double size = 0.0;   ///< of what was to be done
  double limit = 0.0;  ///< of what is done at most; association: hypotheses
};

/// A row of decisions.csv of a kind that this version does not know: listed as it is.
struct OtherDecision {
  std::string kind;
  std::string verdict;
  std::vector<std::pair<std::string, double>> numbers;
};

/// A decision of the navigator that is worth a sentence, with the numbers that decided it.
using Decision = std::variant<TriggerDecision, RollbackDecision, SlipDecision, LostBySlipDecision, MovingDecision,
                              SystematicDecision, NoiseDecision, AttemptStarted, AttemptEnded, ReferenceUnusable,
                              VerificationDecision, ShapeDecision, ClosureDecision, UndecidedDecision,
                              NewGroundDecision, SmoothingDecision, FixDecision, CarriedDecision, PlacedDecision,
                              WholeMapDecision, PostponedDecision, OtherDecision>;

/// True for what ends a search: a closing accepted or refused, new ground, or a search given up.
inline bool is_closure(const Decision& decision) {
  return std::holds_alternative<ClosureDecision>(decision) || std::holds_alternative<UndecidedDecision>(decision) ||
         std::holds_alternative<NewGroundDecision>(decision);
}

/// True for what begins a part of the drive.
inline bool begins_part(const Decision& decision) { return std::holds_alternative<CarriedDecision>(decision); }

/// True for what begins a search.
inline bool is_trigger(const Decision& decision) {
  return std::holds_alternative<TriggerDecision>(decision) || std::holds_alternative<RollbackDecision>(decision);
}

}  // namespace helixnav::core
