// SPDX-License-Identifier: GPL-3.0-or-later
// Speed of writing results as VTU, beside the speed of writing as many bytes raw; neither waits for the disk.
#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <stdexcept>
#include <vector>

#include "operators/registry.hpp"
#include "tests/solver/meshes.hpp"

namespace {

using namespace msml;
namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

double since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

Field field(const std::string& name, int components, int count) {
  Field made{.name = name, .components = components};
  for (int i = 0; i < components * count; ++i) made.values.push_back(0.001 * i);
  return made;
}

/// A beam of 15 n^3 * 2 quadratic tetrahedra with displacement, stress and one number per cell.
Value results(int n) {
  Mesh mesh = fe::testing::box_mesh(5 * n, n, n, {0.1, 0.02, 0.02}, CellKind::tet10);
  mesh.point_fields = {field("displacement", 3, mesh.point_count()), field("stress", 6, mesh.point_count())};
  mesh.cell_fields = {field("energy", 1, mesh.cell_count())};
  return std::make_shared<const Mesh>(std::move(mesh));
}

double write_raw(const fs::path& path, const std::vector<char>& bytes) {
  const Clock::time_point start = Clock::now();
  const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
  if (file < 0) throw std::runtime_error("cannot write " + path.string());
  for (std::size_t done = 0; done < bytes.size();) {
    const ssize_t more = ::write(file, bytes.data() + done, std::min<std::size_t>(bytes.size() - done, 1 << 20));
    if (more <= 0) throw std::runtime_error("cannot write " + path.string());
    done += static_cast<std::size_t>(more);
  }
  ::close(file);
  return since(start);
}

void run(const fs::path& folder, int n) {
  Registry registry;
  add_operators(registry);
  const Value value = results(n);
  const fs::path path = folder / "write_bench.vtu", raw = folder / "write_bench.raw";
  std::vector<double> times, raw_times;
  for (int turn = 0; turn < 6; ++turn) {
    fs::remove(path), fs::remove(raw);
    const Clock::time_point start = Clock::now();
    registry.format(path)->write(value, path, ".vtu");
    const double seconds = since(start);
    const double raw_seconds = write_raw(raw, std::vector<char>(fs::file_size(path), 'x'));
    if (turn == 0) continue;  // the first one opens libraries
    times.push_back(seconds), raw_times.push_back(raw_seconds);
  }
  const double megabytes = 1e-6 * static_cast<double>(fs::file_size(path));
  fs::remove(path), fs::remove(raw);
  std::sort(times.begin(), times.end()), std::sort(raw_times.begin(), raw_times.end());
  fmt::print("{{\"answer\": {}, \"total\": {}, \"rate\": {}, \"megabytes\": {}}}\n", times[2], times[2],
             raw_times[2] / times[2], megabytes);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) return fmt::print(stderr, "usage: write_bench FOLDER N\n"), 2;
  try {
    run(argv[1], std::stoi(argv[2]));
  } catch (const std::exception& error) {
    return fmt::print(stderr, "write_bench: {}\n", error.what()), 2;
  }
}
