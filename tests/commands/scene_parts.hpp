// SPDX-License-Identifier: GPL-3.0-or-later
// A scene of one box in parts, each on a line of its own, and what the compiler says of it.
#pragma once
#include "tests/commands/real_language.hpp"

namespace msml {

/// What a scene says about one box.
struct Parts {
  std::string mesh = R"(<linearTet mesh="${b}"/>)";                                        // line 2
  std::string region = R"(<linearElasticMaterial youngModulus="1" poissonRatio="0.3"/>)";  // line 4
  std::string solver = R"(<solver timeIntegration="static"/>)";                            // line 10
  std::string constraint = "";                                                             // line 6
  std::string step = R"(<step gravity="0 0 0"/>)";                                         // line 12
  std::string output = "";                                                                 // line 8
};

inline Compilation compiled(const Parts& parts) {
  const std::string scene =
      "<msml><scene><object><mesh>\n" + parts.mesh + "\n</mesh><material><region indices=\"${i}\">\n" + parts.region +
      "\n</region></material><constraints><constraint>\n" + parts.constraint +
      "\n</constraint></constraints><output>\n" + parts.output + "\n</output></object></scene><environment>\n" +
      parts.solver + "\n<simulation>\n" + parts.step +
      "\n</simulation></environment><workflow><GenerateBoxMesh id=\"b\" size=\"1 1 1\" divisions=\"1 1 1\"/>"
      "<ComputeIndicesFromBoxROI id=\"i\" mesh=\"${b}\" select=\"points\" box=\"0 0 0 1 1 1\"/></workflow></msml>";
  return compile_text(scene, "/nonexistent/s.xml", real_language(), {.output_folder = "/nonexistent"});
}

/// Its faults, line by line.
inline std::string faults(const Parts& parts) { return tiny::lines(compiled(parts).faults); }

/// Its warnings, line by line.
inline std::string warnings(const Parts& parts) { return tiny::lines(compiled(parts).warnings); }

}  // namespace msml
