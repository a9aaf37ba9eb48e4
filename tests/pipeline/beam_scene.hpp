// SPDX-License-Identifier: GPL-3.0-or-later
// A small beam under gravity as a scene, with parts that a test may change.
#pragma once
#include <string>

namespace msml::testing {

struct BeamScene {
  std::string divisions = "10 2 2";
  std::string law = "youngModulus=\"1e5\" poissonRatio=\"0.3\"";
  std::string solver = "timeIntegration=\"static\" linearSolver=\"direct\"";
  std::string step = "gravity=\"0 0 -9.81\"";
  std::string output = "<displacement id=\"disp\" timestep=\"1\"/>";
  std::string tasks;
  std::string str() const {
    return "<msml>\n<workflow>\n<GenerateBoxMesh id=\"beam\" size=\"0.1 0.02 0.02\" divisions=\"" + divisions +
           "\"/>\n<ComputeIndicesFromBoxROI id=\"all\" mesh=\"${beam}\" select=\"elements\" box=\"-1 -1 -1 1 1 1\"/>\n"
           "<ComputeIndicesFromBoxROI id=\"wall\" mesh=\"${beam}\" select=\"points\" box=\"-1e-6 -1 -1 1e-6 1 1\"/>\n" +
           tasks + "\n</workflow>\n<scene><object id=\"body\">\n<mesh><linearTet mesh=\"${beam}\"/></mesh>\n" +
           "<material><region indices=\"${all}\">\n<linearElasticMaterial " + law +
           "/>\n<mass massDensity=\"1000\"/></region></material>\n<constraints><constraint>\n"
           "<fixedConstraint indices=\"${wall}\"/></constraint></constraints>\n<output>" +
           output + "</output></object></scene>\n<environment><solver " + solver +
           "/>\n<simulation><step name=\"load\" " + step + "/></simulation></environment></msml>\n";
  }
};

}  // namespace msml::testing
