/// What of others is built into the program: versions, licences, and which licence the whole has by them.
#pragma once

#include <string>
#include <vector>

namespace waymark::program {

/// What a licence asks of those who hand the program on.
enum class LicenceTerms {
  permissive,  ///< name the authors; MPL-2.0 too: only its own files stay under it
  lgpl,        ///< the user must be able to exchange the library
  gpl          ///< the whole program goes out under the GPL
};

struct Library {
  std::string name;
  std::string version;  ///< of the one that is running, where the library tells; else of its headers
  std::string licence;
  LicenceTerms terms = LicenceTerms::permissive;
  std::string use;  ///< what it is there for
};

/// Linear solvers first, then the peer, then the rest.
[[nodiscard]] std::vector<Library> built_in_libraries();

/// The strictest terms of all.
[[nodiscard]] LicenceTerms licence_mode(const std::vector<Library>& libraries);

/// "permissive", "LGPL", "GPL".
[[nodiscard]] std::string to_string(LicenceTerms terms);

}  // namespace waymark::program
