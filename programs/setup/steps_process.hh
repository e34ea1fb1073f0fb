// SPDX-License-Identifier: GPL-2.0-or-later
// `millwright commission check --messages` as a child process, for the page of the first steps.
#pragma once

#include "clients/screen/setup/first_steps.hh"

namespace mw::programs {

/// Runs in virtual time for a machine with a simulated board.
Result<std::unique_ptr<screen::StepsProcess>> start_steps(const std::string &ini);

}  // namespace mw::programs
