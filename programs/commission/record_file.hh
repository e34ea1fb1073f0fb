// SPDX-License-Identifier: GPL-2.0-or-later
// The record of commissioning in the folder of a machine: the findings of each step, with dates.
#pragma once

#include <string>
#include <vector>

#include "base/result.hh"
#include "machine/commissioning/guide.hh"

namespace mw::programs {

inline constexpr const char *RECORD_FILE = "commissioning.json";

struct Recorded {
    commissioning::Finding finding;
    setup::Answers basis;  ///< the answers for which it is valid; it is valid until one of them changes
    std::string title;     ///< "Direction of X"
    std::string date;      ///< UTC: "2026-11-30 11:20"
    std::string version;   ///< version of the program
};

/// Nothing when there is no record.
Result<std::vector<Recorded>> read_record(const std::string &folder);
bool isValid(const Recorded &recorded, const setup::Answers &answers);
/// Valid findings without a fault.
std::vector<commissioning::Finding> valid_findings(const std::vector<Recorded> &record,
                                                   const setup::Answers &answers);
/// Adds the findings of a session. A repeated step replaces its older finding.
Result<> write_record(const std::string &folder, const commissioning::Guide &guide, const std::string &date,
                      const std::string &version);

}  // namespace mw::programs
