// SPDX-License-Identifier: GPL-2.0-or-later
// Commissions a machine with its owner, and judges the result by the true values.
#pragma once

#include <filesystem>
#include <string>

namespace mw::commissioning_campaign {

/// One line: figures, then "ok" or "FAILED rule: what".
std::string run_session(unsigned seed, const std::filesystem::path &folder, bool isTold);

}  // namespace mw::commissioning_campaign
