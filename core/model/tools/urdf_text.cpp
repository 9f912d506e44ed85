// SPDX-License-Identifier: GPL-3.0-or-later
// A URDF file parsed by urdfdom, with its printed messages as an InputError.
#include "core/model/tools/urdf_text.h"

#include <console_bridge/console.h>
#include <urdf_parser/urdf_parser.h>

#include <mutex>
#include <string>

#include "core/base/text.h"
#include "core/model/formats/file_bytes.h"
#include "core/xml/document.h"

namespace insula {
namespace {

/// Keeps the messages of urdfdom while it exists. console_bridge has one handler for the whole process, hence the lock.
class ConsoleCapture : public console_bridge::OutputHandler {
 public:
  ConsoleCapture()
      : lock_(mutex()), level_(console_bridge::getLogLevel()), previous_(console_bridge::getOutputHandler()) {
    console_bridge::setLogLevel(console_bridge::CONSOLE_BRIDGE_LOG_ERROR);
    console_bridge::useOutputHandler(this);
  }
  ~ConsoleCapture() override {
    console_bridge::useOutputHandler(previous_);
    console_bridge::setLogLevel(level_);
  }
  void log(const std::string& text, console_bridge::LogLevel level, const char*, int) override {
    if (level < console_bridge::CONSOLE_BRIDGE_LOG_ERROR) return;
    if (!errors.empty()) errors += "; ";
    errors += trim(text);
  }
  std::string errors;

 private:
  static std::mutex& mutex() {
    static std::mutex one;
    return one;
  }
  std::lock_guard<std::mutex> lock_;
  console_bridge::LogLevel level_;
  console_bridge::OutputHandler* previous_;
};

}  // namespace

urdf::ModelInterfaceSharedPtr parse_urdf(const std::filesystem::path& file) {
  const std::string text = read_file_bytes(file, 1u << 20);
  // urdfdom's XML parser is recursive and gives no good positions, so the text is first read by our parser.
  Diagnostics diagnostics;
  parse_document(text, file.string(), diagnostics);
  if (!diagnostics.ok()) {
    std::string lines = diagnostics.format();
    while (!lines.empty() && lines.back() == '\n') lines.pop_back();
    throw InputError(lines);
  }
  urdf::ModelInterfaceSharedPtr model;
  ConsoleCapture console;
  try {
    model = urdf::parseURDF(text);
  } catch (const std::exception& e) {
    fail(file, "is no valid URDF: " + shown(e.what()));
  }
  if (!console.errors.empty()) fail(file, "is no valid URDF: " + console.errors);
  if (!model) fail(file, "is no valid URDF");
  return model;
}

}  // namespace insula
