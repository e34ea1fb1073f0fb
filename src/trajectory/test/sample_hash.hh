// SPDX-License-Identifier: GPL-2.0-or-later
// A hash of a sequence of values (FNV-1a). A change of any bit changes the hash.
#pragma once

#include <bit>
#include <cstdint>

#include "base/geometry/pose.hh"

namespace mw::trajectory::test {

class SampleHash {
  public:
    void add(double x) {
        const auto bits = std::bit_cast<std::uint64_t>(x);
        for (int i = 0; i < 64; i += 8) {
            value_ = (value_ ^ ((bits >> i) & 0xffU)) * 0x100000001b3ULL;
        }
    }
    void add(const geometry::Pose &pose) {
        for (int i = 0; i < geometry::AXIS_COUNT; ++i) {
            add(pose[i]);
        }
    }
    unsigned long long value() const { return value_; }

  private:
    std::uint64_t value_ = 0xcbf29ce484222325ULL;
};

}  // namespace mw::trajectory::test
