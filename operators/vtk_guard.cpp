// SPDX-License-Identifier: GPL-3.0-or-later
// An output window for VTK that keeps error texts for the thread that caused them.
#include "operators/vtk_guard.hpp"

#include <vtkAlgorithm.h>
#include <vtkLogger.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkOutputWindow.h>

#include <algorithm>
#include <exception>
#include <mutex>
#include <new>

#include "msml/core/error.hpp"

namespace msml::operators {
namespace {

/// Where the errors of the current thread go; null outside guarded(). VTK's output window is one per process, so the
/// thread is all that tells two readers apart.
thread_local std::string* first_error = nullptr;

class CollectingWindow : public vtkOutputWindow {
 public:
  static CollectingWindow* New();
  vtkTypeMacro(CollectingWindow, vtkOutputWindow);
  void DisplayErrorText(const char* text) override {
    if (first_error == nullptr) return vtkOutputWindow::DisplayErrorText(text);
    if (first_error->empty()) *first_error = text;
  }
  void DisplayWarningText(const char* text) override {
    if (first_error == nullptr) vtkOutputWindow::DisplayWarningText(text);
  }
  void DisplayGenericWarningText(const char* text) override {
    if (first_error == nullptr) vtkOutputWindow::DisplayGenericWarningText(text);
  }
  void DisplayText(const char* text) override {
    if (first_error == nullptr) vtkOutputWindow::DisplayText(text);
  }
};
vtkStandardNewMacro(CollectingWindow);

void install_window() {
  static std::once_flag once;
  std::call_once(once, [] {
    const vtkNew<CollectingWindow> window;
    vtkOutputWindow::SetInstance(window);
    vtkLogger::SetStderrVerbosity(vtkLogger::VERBOSITY_OFF);  // the logger prints beside the window
  });
}

/// "ERROR: In file.cxx, line 3\nvtkReader (0x12): Words.\n\n" -> "Words."
std::string shortened(const std::string& text) {
  const auto head = text.find("): ");
  std::string words = head == std::string::npos ? text : text.substr(head + 3);
  std::replace(words.begin(), words.end(), '\n', ' ');
  const auto end = words.find_last_not_of(" .");
  words.erase(end == std::string::npos ? 0 : end + 1);
  constexpr std::size_t longest = 200;
  if (words.size() > longest) words = words.substr(0, longest) + " …";
  return words.empty() ? "unspecified error" : words;
}

}  // namespace

void guarded(const std::string& what, const std::function<void()>& work) {
  install_window();
  std::string error;
  std::string* const outer = first_error;
  const struct Restore {
    std::string* outer;
    ~Restore() { first_error = outer; }
  } restore{outer};
  first_error = &error;
  try {
    work();
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw Error(what + ": not enough memory for the sizes it announces");
  } catch (const std::exception& e) {
    throw Error(what + ": " + e.what());
  }
  if (!error.empty()) throw Error(what + ": " + shortened(error));
}

void update(vtkAlgorithm& algorithm, const std::string& what) {
  guarded(what, [&] { algorithm.Update(); });
}

}  // namespace msml::operators
