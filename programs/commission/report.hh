// SPDX-License-Identifier: GPL-2.0-or-later
// The report of a machine for its acceptance: findings, values, a checklist and fields for signatures.
#pragma once

#include <string>
#include <vector>

#include "machine/setup/questions.hh"
#include "programs/commission/record_file.hh"

namespace mw::programs {

struct ReportFacts {
    std::string folder, version, date;
    setup::Answers answers;
    std::vector<Recorded> record;
};

std::string report_text(const ReportFacts &facts);
/// A printable page that needs no other files.
std::string report_html(const ReportFacts &facts);

}  // namespace mw::programs
