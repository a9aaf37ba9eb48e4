// SPDX-License-Identifier: GPL-3.0-or-later
// A scene for studies: a column under its own weight, 4 x 4 x 4, nu = 0, E = ${E}, of ${n} cubes an edge.
#pragma once
#include <string>

namespace msml::studies {

/// The scene with the tags of `studies`, which start on its last line.
inline std::string bar(const std::string& studies, const std::string& units = "") {
  return R"(<msml><variables><var name="n" value="1"/><var name="E" value="1000"/><var name="kind" value="tet4"/><var name="low" value="-9"/><var name="parts" value="1"/></variables>
<workflow>
  <GenerateBoxMesh id="mesh" size="4 4 4" divisions="${n} ${n} ${n}" when="${kind} = tet4"/>
  <GenerateBoxMesh id="mesh" size="4 4 4" divisions="${n} ${n} ${n}" quadratic="true" when="${kind} = tet10"/>
  <ComputeIndicesFromBoxROI id="all" mesh="${mesh}" select="elements" box="-9 -9 -9 9 9 9"/>
  <ComputeIndicesFromBoxROI id="base" mesh="${mesh}" select="points" box="-9 -9 ${low} 9 9 1e-6"/>
</workflow>
<scene><object id="bar">
  <mesh> <linearTet mesh="${mesh}" when="${kind} = tet4"/> <quadraticTet mesh="${mesh}" when="${kind} = tet10"/> </mesh>
  <material><region indices="${all}"> <linearElasticMaterial youngModulus="${E}" poissonRatio="0" strain="small"/>
    <mass massDensity="1"/> </region></material>
  <constraints><constraint> <fixedConstraint indices="${base}"/> </constraint></constraints>
  <output> <displacement id="u"/> <probe id="tip" point="2 2 4" field="displacement"/> </output>
</object></scene>
<environment units=")" +
         units + R"("><solver timeIntegration="static" linearSolver="direct" loadSteps="${parts}"/>
  <simulation><step gravity="0 0 -10"/></simulation></environment>
<studies>)" +
         studies + "</studies></msml>";
}

}  // namespace msml::studies
