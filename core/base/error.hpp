/// The exceptions of Waymark. A library throws these and never prints or exits; `tools/program`
/// maps each kind to an exit code.
#pragma once

#include <stdexcept>
#include <string>

#include <waymark/core/base/export.hpp>

namespace WAYMARK_EXPORT waymark {

/// The base of all errors that Waymark raises on purpose. An exception without this base is a
/// defect (internal error).
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
  ~Error() override;  // key function: one typeinfo across shared libraries and modules
};

/// The caller requested something that does not exist or does not fit: an unknown solver, a wrong
/// option value.
class UsageError : public Error {
 public:
  using Error::Error;
  ~UsageError() override;
};

/// An input file, log or graph is wrong. The message starts with the place ("run.graph:812:17: ")
/// if there is one, and says what was expected.
class InputError : public Error {
 public:
  using Error::Error;
  ~InputError() override;
};

/// A log is sound and holds nothing that counts: it is empty, or all of it is without a fix.
class EmptyLogError : public InputError {
 public:
  using InputError::InputError;
  ~EmptyLogError() override;
};

/// An output could not be written completely. No partial file is left under the final name.
class OutputError : public Error {
 public:
  using Error::Error;
  ~OutputError() override;
};

/// Code of a plugin failed: it threw something that is none of these errors, or returned nothing.
class PluginError : public Error {
 public:
  /// @param type tag or name of the registered type that failed; empty: not known
  explicit PluginError(const std::string& message, std::string type = {});
  ~PluginError() override;

  [[nodiscard]] const std::string& type() const { return type_; }

 private:
  std::string type_;
};

}  // namespace waymark
