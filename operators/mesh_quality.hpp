// SPDX-License-Identifier: GPL-3.0-or-later
// Measures of the shape of tetrahedra, and statistics of them.
#pragma once
#include <array>
#include <string>
#include <vector>

#include "msml/core/mesh.hpp"

namespace msml::operators {

/// Shape of one tetrahedron. For a tet10 all but volume and scaled Jacobian are those of its corners.
struct TetQuality {
  double volume = 0;        ///< signed; of a tet10 the curved volume
  double edge_ratio = 0;    ///< longest over shortest edge, >= 1; 1 for the regular tetrahedron
  double min_dihedral = 0;  ///< smallest angle between two faces, degrees; 70.5288 for the regular one
  double max_dihedral = 0;  ///< largest, degrees
  double radius_ratio = 0;  ///< circumradius over three times the inradius, >= 1; 1 for the regular one
  double radius_edge = 0;   ///< circumradius over shortest edge, >= sqrt(6)/4 = 0.6124
  /// tet4: sqrt(2) det(three edges at a corner) over the product of their lengths, smallest of the four corners; 1 for
  /// the regular one, <= 0 if inverted. tet10: that of the corners times the smallest Jacobian over the mean one (lower
  /// bound from the Bernstein coefficients); 1 at most for straight edges.
  double scaled_jacobian = 0;
};

/// A tetrahedron without volume has finite measures at most 1e300.
TetQuality quality_of(const Eigen::Matrix<double, 4, 3>& corners);
TetQuality quality_of(const Eigen::Matrix<double, 10, 3>& nodes);

/// Name in fields and tables, unit, and where bad lies.
struct Measure {
  std::string name;
  double TetQuality::*value;
  bool small_is_bad;
  double regular;  ///< value of the regular tetrahedron; 0 = depends on size
};

/// volume, edgeRatio, minDihedralAngle, maxDihedralAngle, radiusRatio, radiusEdgeRatio, scaledJacobian.
const std::vector<Measure>& measures();

struct Statistics {
  double min = 0, mean = 0, max = 0;
  std::array<double, 7> percentiles{};  ///< at Statistics::at
  static constexpr std::array<double, 7> at{1, 5, 25, 50, 75, 95, 99};
  std::vector<long> histogram;  ///< equal bins from low to high; what lies outside counts in the end bins
  double low = 0, high = 0;
};

/// Statistics of a non-empty list; percentiles interpolate linearly between sorted values.
Statistics statistics(std::vector<double> values, double low, double high, int bins);

}  // namespace msml::operators
