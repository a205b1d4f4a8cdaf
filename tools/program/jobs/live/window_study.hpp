/// `run --window`: the drive fused as `live` does, in windows of several lengths, beside the run of the whole.
#pragma once

#include <span>
#include <string>

#include <waymark/tools/drawing/page/page.hpp>
#include <waymark/tools/drive/description/drive_file.hpp>
#include <waymark/tools/drive/logs/prepare.hpp>
#include <waymark/tools/program/terminal/console.hpp>

namespace waymark::program {

struct WindowStudyInput {
  const drive::DriveFile& file;
  const drive::FusionSettings& settings;  ///< as stated: the noise is found on the way
  const drive::PreparedDrive& drive;
  std::span<const double> windows_s;
  std::string folder;       ///< of the results
  double whole_rmse_m = 0;  ///< of the run of the whole drive, at the fixes; NaN: unknown
};

struct WindowStudy {
  std::string text;          ///< a table for people
  drawing::Section section;  ///< figures of accuracy and consistency over the window
};

/// Fuses the drive once for each window, and writes MODELING.windows.csv. @throws as an interrupted run does
[[nodiscard]] WindowStudy study_windows(const WindowStudyInput& input, const TypeRegistry& registry,
                                        const Console& console);

}  // namespace waymark::program
