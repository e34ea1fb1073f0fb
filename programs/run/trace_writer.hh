// SPDX-License-Identifier: GPL-2.0-or-later
// The trace of a run: one CSV row per servo cycle, full double precision, machine units.
#pragma once

#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>

#include "base/result.hh"
#include "motion/interface/channels.hh"

namespace mw::programs {

/// Columns: time_ns (from program start), line, axis.L per configured axis (carte_pos_cmd), joint.N
/// (pos_cmd).
class TraceWriter {
  public:
    static Result<TraceWriter> create(const std::string &path, unsigned axis_mask, int num_joints);

    void write(const motion::TraceSample &sample);
    /// Flushes and closes; an error if data could not be written.
    Result<> close();

  private:
    TraceWriter(std::FILE *file, std::string path, unsigned axis_mask, int num_joints);

    std::unique_ptr<std::FILE, int (*)(std::FILE *)> file_;
    std::string path_;
    std::string row_;
    unsigned axis_mask_;
    int num_joints_;
    std::int64_t start_ns_ = -1;
    bool failed_ = false;
};

}  // namespace mw::programs
