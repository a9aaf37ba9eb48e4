// SPDX-License-Identifier: GPL-3.0-or-later
// The results of a study as JSON, with all that is needed to take them again.
#pragma once
#include <map>
#include <string>

#include "msml/compile/compile.hpp"
#include "msml/study/runner.hpp"

namespace msml {

/// "AMD EPYC 7763, 2 processors, 16.4 GB, Linux 6.1": what timings depend on.
std::string machine();

/// What a session ran, and how.
struct Session {
  const Compilation& scene;  ///< the scene as the command line set it
  CompileOptions given;      ///< what the command line says of it
  StudyOptions options;
  bool fresh = false;                           ///< rows of earlier sessions do not count
  std::map<std::string, std::string> versions;  ///< of the libraries, by name
  Sharing sharing;
  double seconds = 0;
};

/// The definition of the study, the session (scene and input files with hashes of what they hold, variables in force,
/// the choices of the command line, versions, machine, units and labels of every column), and one object per row with
/// numbers as numbers.
std::string study_json(const Study& study, const Table& table, const Session& session);

}  // namespace msml
