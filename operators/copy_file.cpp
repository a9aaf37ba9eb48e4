// SPDX-License-Identifier: GPL-3.0-or-later
// copyFile: a file under another name.
#include "msml/core/operator.hpp"

namespace msml::operators {

Operator copy_file();

namespace {

File existing(const File& file) {
  if (!std::filesystem::exists(file.path)) throw Error("no such file: " + file.path.string());
  if (std::filesystem::is_directory(file.path)) throw Error(file.path.string() + " is a folder, not a file");
  return file;
}

}  // namespace

Operator copy_file() {
  Operator op("copyFile", "Copies a file, byte by byte, to another name.");
  op.note(
      "Of a series of states the last file is copied. The extension of the copy is not looked at: nothing is "
      "converted.");
  op.note(
      "filename_out is relative to the output folder, and a folder in it is kept; MSML dropped that folder where "
      "working_directory is true. Here working_directory is accepted and has no effect.");
  const auto in = op.input<File>("filename_in", "the file to copy, or the output of a simulation");
  op.parameter<bool>("working_directory", {.fallback = true, .doc = "accepted for old scenes, without effect"});
  const auto copy = op.output<File>("copy", "the file");
  op.target("filename_out", copy, "name of the copy");
  op.run([=](Context& c) { c.set(copy, existing(c.get(in))); });
  return op;
}

}  // namespace msml::operators
