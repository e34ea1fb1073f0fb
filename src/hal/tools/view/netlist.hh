// SPDX-License-Identifier: GPL-2.0-or-later
// The connections of a HAL instance as a drawing.
#pragma once

#include <string>

#include "base/result.hh"
#include "hal/core/instance.hh"

namespace mw::hal::view {

struct NetlistOptions {
    std::string glob = "*";      ///< matching components or instances, with the objects linked to them
    bool showsUnlinked = false;  ///< also pins without a signal
    bool showsValues = false;    ///< also the current values of signals
};

/// A graph in the Graphviz language: a box for each instance (the pins' names up to their last dot) with its
/// linked pins, inputs left, outputs right; an edge for each reader from the signal's writer, or from a node
/// of the signal when it has none or several.
std::string netlist_dot(Instance &hal, const NetlistOptions &options);

/// Writes `path` by its extension: .dot is the text itself; .svg, .png and .pdf are made by Graphviz' program
/// dot.
Result<> write_netlist(Instance &hal, const NetlistOptions &options, const std::string &path);

}  // namespace mw::hal::view
