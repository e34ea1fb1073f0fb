// SPDX-License-Identifier: GPL-2.0-or-later
// A canon without effect, to check whether a program can be interpreted.
#pragma once

#include "gcode/canon/canon.hh"

namespace mw::gcode {

class QuietCanon final : public Canon {
  public:
    void begin_block(const BlockRef &) override {}
    void take(const CanonCall &) override {}
};

}  // namespace mw::gcode
