// SPDX-License-Identifier: GPL-2.0-or-later
// The certificate of motion of a run: as a JSON file, and as a table for persons (docs/user/certificate.md).
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "base/result.hh"
#include "machine/certificate/motion_certificate.hh"
#include "machine/config/machine_config.hh"

namespace mw::programs {

struct CertificateReport {
    std::string program;
    const machine::MachineConfig &machine;
    machine::Certificate certificate;
    double cycle_time_s = 0;
    bool wasFinished = true;  ///< the program ran to its end
    bool was_realtime = false;
    /// The file of a move (task's table of files).
    std::function<std::string(std::uint32_t file_index)> file_name;
};

/// The JSON document.
std::string certificate_json(const CertificateReport &report);
/// Replaces the file by the JSON document atomically.
Result<> write_certificate(const CertificateReport &report, const std::string &path);
/// A line for each axis, joint and norm with limits, for the path, and for each exceeded limit.
std::string certificate_table(const CertificateReport &report);
/// The maximum use of a limit, and the path deviation, in one line.
std::string certificate_line(const CertificateReport &report);

}  // namespace mw::programs
