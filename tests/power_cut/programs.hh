// SPDX-License-Identifier: GPL-2.0-or-later
// Random programs of a few seconds with typical blocks.
#pragma once

#include <random>
#include <string>
#include <vector>

namespace mw::power_cut {

struct Job {
    std::vector<std::string> mdi;  ///< before the program
    std::string program;
};

Job make_job(std::mt19937_64 &random);

}  // namespace mw::power_cut
