// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

#include "helixnav/core/landmark_graph.hpp"
#include "helixnav/core/recording.hpp"

namespace helixnav::logs {

/// Reads a planar landmark graph in g2o's text: VERTEX_SE2, VERTEX_XY, EDGE_SE2, EDGE_SE2_XY, EDGE_BEARING_SE2_XY, with
/// the upper triangle of each information matrix by rows; FIX lines and comments are skipped. Vertices keep the file's
/// numbers as names; edges may come before their vertices. Frames are the file's own: nothing is rotated. Throws
/// core::InputError naming file:line for an unknown tag, a field too few or too many, an invalid number, a duplicate
/// vertex, an edge to a vertex that is missing or of the wrong kind, or an information matrix that is not positive
/// definite. Test: logs/graph_files_test.cpp.
core::LandmarkGraph read_g2o(const std::filesystem::path& path);

/// Writers of the same graph for other solvers. All keep the names of poses and landmarks if no landmark has the same
/// number as a pose, since these formats have one set of numbers for both; else landmarks are shifted beyond the last
/// pose. Cartesian observations are exact, range and bearing become points to first order; bearings only in g2o,
/// without a lever arm. What a format cannot hold (ranges alone, fixes) is a core::InputError. Test:
/// logs/graph_files_test.cpp (round trips, χ²).
void write_g2o(const core::LandmarkGraph& graph, const std::filesystem::path& path);
/// iSAM: ODOMETRY and LANDMARK lines with the upper triangular square root U of the information, UᵀU = C⁻¹.
void write_isam(const core::LandmarkGraph& graph, const std::filesystem::path& path);
/// The same lines as in GTSAM's Victoria Park example: with the covariance.
void write_gtsam(const core::LandmarkGraph& graph, const std::filesystem::path& path);

/// The drive that a graph describes, for programs that work step by step: the poses in the order of their odometry
/// chain, one Odometry and one Scan per pose (t = index in seconds), labels = names of the landmarks. The field of view
/// is empty (maximum range 0): a pose without an observation says nothing about what is there. Throws core::InputError
/// when pose-to-pose edges do not form a single chain.
core::Recording recording_from_graph(const core::LandmarkGraph& graph, std::string name);

/// Reads the one-step local maps of 2D-I-SLSJF (VicPark_clean_data.mat, matio): rows [1 from to dx dy dφ Cxx Cxy Cxφ Cyy Cyφ Cφφ]
/// and [0 pose landmark x y Cxx Cxy Cyy 0 …]. One Odometry and one Scan per pose, t = pose number in seconds, labels from
/// the file, true identities as its authors associated them; the field of view is empty. x ahead, y left as in the file.
/// Throws core::InputError naming file and row. Test: logs/graph_files_test.cpp.
core::Recording read_vicpark_clean(const std::filesystem::path& path);

}  // namespace helixnav::logs
