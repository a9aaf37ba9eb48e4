// SPDX-License-Identifier: GPL-3.0-or-later
// A scene with one object whose parts can be exchanged.
#pragma once
#include "tests/compile/scenes.hpp"

namespace msml::tiny {

/// Parts of the scene; each stands on the line named.
struct Parts {
  std::string mesh = "<linearTet mesh=\"${m}\"/>";                             ///< 3
  std::string region = "indices=\"${r}\"";                                     ///< 5
  std::string law = "<softMaterial youngModulus=\"3000\"/>";                   ///< 5
  std::string constraint = "<hold indices=\"0 1\" forStep=\"push\"/>";         ///< 8
  std::string output = "<states id=\"disp\"/>";                                ///< 11
  std::string environment = "<simulation><step name=\"push\"/></simulation>";  ///< 15
  std::string tasks = "";                                                      ///< 17
};

/// A scene with a meshed and picked body.
inline std::string object(const Parts& p) {
  return "<msml><scene>\n<object id=\"body\">\n<mesh>" + p.mesh + "</mesh>\n<material>\n<region " + p.region + ">" +
         p.law + "</region>\n</material>\n<constraints><constraint>\n" + p.constraint +
         "\n</constraint></constraints>\n<output>\n" + p.output + "\n</output>\n</object></scene>\n<environment>\n" +
         p.environment + "</environment>\n<workflow>\n" + p.tasks +
         "<MakeSurface id=\"s\"/>"
         "<Fill id=\"m\" surfaceMesh=\"${s}\" cellSize=\"1\"/>"
         "<Pick id=\"r\" mesh=\"${m}\" box=\"0 0 0 1 1 1\" select=\"elements\"/></workflow></msml>";
}

}  // namespace msml::tiny
