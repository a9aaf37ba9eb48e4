// SPDX-License-Identifier: GPL-3.0-or-later
// The matrix of laws, elements and integrations.
#include "tests/verification/matrix.hpp"

#include <fmt/format.h>

#include <fstream>
#include <iostream>

namespace msml::verification {
namespace {

using Json = nlohmann::json;
using Notes = std::map<std::string, std::vector<std::string>>;  ///< reason -> combinations

constexpr double balanced = 1e-6;  // residual over the largest force, a hundred times Newton's tolerance

Method combined(const Json& law, const Json& element, const Json& integration) {
  Method method;
  method.name = fmt::format("{}, {}, {}", law.at("name").get<std::string>(), element.at("name").get<std::string>(),
                            integration.at("name").get<std::string>());
  for (const Json* part : {&element, &law, &integration})
    for (const auto& [from, to] : part->at("replace").items()) method.replace[from] = to.get<std::string>();
  method.measure.node = "body";
  method.measure.pointer = "/check/residual";
  method.limit = balanced;
  return method;
}

/// What the program said, without the place: from the name of the file on.
std::string reason_of(const std::string& remark) {
  const std::size_t scene = remark.find(".msml.xml:");
  const std::size_t text = scene == std::string::npos ? scene : remark.find(": ", scene + 10);
  return text == std::string::npos ? remark : remark.substr(text + 2);
}

struct Count {
  int ran = 0, failed = 0, all = 0;
};

Count run_all(const Program& program, const Case& each, const Json& law, const Json& element, const Json& integrations,
              Notes& refused, Notes& failed) {
  Count count;
  for (const Json& integration : integrations) {
    const Method method = combined(law, element, integration);
    Runs runs;
    const Row row = run_method(program, each, method, runs).back();
    ++count.all;
    if (row.pass) {
      ++count.ran;
    } else if (row.remark.starts_with("exit code 2")) {
      refused[reason_of(row.remark)].push_back(method.name);
    } else {
      ++count.failed;
      failed[row.error ? fmt::format("residual {:.1e}", *row.error) : reason_of(row.remark)].push_back(method.name);
    }
  }
  return count;
}

void write_notes(const char* title, const Notes& notes, std::ostream& out) {
  if (!notes.empty()) out << "\n## " << title << "\n\n";
  for (const auto& [reason, combinations] : notes)
    out << fmt::format("- {} ({}, such as {})\n", reason, combinations.size(), combinations.front());
}

}  // namespace

int write_matrix(const Program& program) {
  const Json matrix = Json::parse(std::ifstream(program.scenes / "matrix.json"));
  const Case each{.name = "matrix", .scene = matrix.at("scene").get<std::string>(), .source = "", .methods = {}};
  const Json &elements = matrix.at("elements"), &integrations = matrix.at("integrations");
  std::filesystem::create_directories(program.results);
  std::ofstream out(program.results / "matrix.md");
  out << "# Laws, elements and integrations\n\nWritten by `./dev verify --matrix`: how many of the integrations";
  for (const Json& integration : integrations) out << " " << integration.at("name").get<std::string>();
  out << " ran to the end in balance (residual below 1e-6 of the forces). Empty: none makes sense.\n\n| law |";
  for (const Json& element : elements) out << " " << element.at("name").get<std::string>() << " |";
  out << "\n|---|";
  for (std::size_t i = 0; i < elements.size(); ++i) out << "---:|";
  Notes refused, failed;
  int failures = 0;
  for (const Json& law : matrix.at("laws")) {
    out << "\n| " << law.at("name").get<std::string>() << " |";
    for (const Json& element : elements) {
      const Count count = run_all(program, each, law, element, integrations, refused, failed);
      failures += count.failed;
      out << (count.ran > 0 || count.failed > 0 ? fmt::format(" {} |", count.ran) : " |");
    }
    std::cout << law.at("name").get<std::string>() << std::endl;
  }
  out << "\n";
  write_notes("Failed", failed, out);
  write_notes("Refused", refused, out);
  return failures;
}

}  // namespace msml::verification
