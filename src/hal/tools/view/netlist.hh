// SPDX-License-Identifier: GPL-2.0-or-later
// The connections of a HAL instance as a drawing.
#pragma once

#include <string>

#include "base/result.hh"
#include "hal/core/hal.hh"

namespace mw::hal::view {

struct NetlistOptions {
    std::string glob = "*";      ///< components or instances that match, with what they are linked to
    bool showsUnlinked = false;  ///< pins without a signal, too
    bool showsValues = false;    ///< signals' values at this moment
};

/// A graph in the language of Graphviz: a box for each instance (the pins' names up to their last dot) with
/// its linked pins, inputs left, outputs right; an edge for each reader from the signal's writer, or from a
/// node of the signal when it has none or several.
std::string netlist_dot(const Hal &hal, const NetlistOptions &options);

/// Writes `path` by its ending: .dot is the text itself, .svg, .png and .pdf go through Graphviz' program
/// dot.
Result<> write_netlist(const Hal &hal, const NetlistOptions &options, const std::string &path);

}  // namespace mw::hal::view
