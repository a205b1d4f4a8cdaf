// A drive fused by a C++ program, as `waymark run` does it.
//   example_fuse_drive DRIVE.yaml
#include <algorithm>
#include <cstdio>

#include <waymark/core/base/error.hpp>
#include <waymark/core/registry/registry.hpp>
#include <waymark/formats/logs/log_readers.hpp>
#include <waymark/plugins/builtin.hpp>
#include <waymark/solvers/register.hpp>
#include <waymark/tools/drive/description/drive_file.hpp>
#include <waymark/tools/drive/model/fuse.hpp>
#include <waymark/tools/drive/model/poses_at_fixes.hpp>
#include <waymark/types_se2/register.hpp>

using namespace waymark;

int main(int count, char** words) {
  if (count != 2) {
    std::fprintf(stderr, "usage: example_fuse_drive DRIVE.yaml\n");
    return 2;
  }
  TypeRegistry registry;
  register_core_types(registry);
  register_se2_types(registry);
  solvers::register_solvers(registry);
  formats::register_log_readers(registry);
  plugins::register_builtin_plugins(registry);
  try {
    const drive::DriveFile file = drive::load_drive_file(words[1]);
    const drive::PreparedDrive drive = drive::load_drive(file.description, registry);
    const drive::FusedDrive fused = drive::fuse(drive, file.settings, registry);
    std::printf("%s", fused.minimum.full().c_str());

    // The fused poses, and how far they are from the receiver's own positions.
    const std::vector<StampedPose> poses = drive::poses_at_fixes(fused.model.document);
    double largest = 0;
    for (std::size_t i = 0; i < poses.size(); ++i) {
      const Fix& fix = fused.model.document.fixes[i];
      if (fix.status != FixStatus::accepted) continue;
      largest = std::max(largest, (poses[i].pose.head<2>() - fix.position).norm());
    }
    std::printf("%zu poses at fixes over %.0f m; at most %.1f m from an accepted fix\n", poses.size(),
                fused.model.distance_m, largest);
    return fused.minimum.converged() && poses.size() == drive.fixes.size() && largest < 100 ? 0 : 1;
  } catch (const Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
