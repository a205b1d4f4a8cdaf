/// The libraries that are built into the program: versions, licences, and the licence that follows
/// for the whole.
#pragma once

#include <string>
#include <vector>

namespace waymark::program {

/// The obligations of a licence for those who distribute the program.
enum class LicenceTerms {
  permissive,  ///< name the authors; also MPL-2.0, which covers only its own files
  lgpl,        ///< the user must be able to replace the library
  gpl          ///< the whole program is distributed under the GPL
};

struct Library {
  std::string name;
  std::string version;  ///< of the running library if it tells, else of its headers
  std::string licence;
  LicenceTerms terms = LicenceTerms::permissive;
  std::string use;  ///< what the program uses it for
};

/// Returns the libraries: linear solvers first, then the peer, then the others.
[[nodiscard]] std::vector<Library> built_in_libraries();

/// Returns the strictest terms of all.
[[nodiscard]] LicenceTerms licence_mode(const std::vector<Library>& libraries);

/// Returns "permissive", "LGPL" or "GPL".
[[nodiscard]] std::string to_string(LicenceTerms terms);

}  // namespace waymark::program
