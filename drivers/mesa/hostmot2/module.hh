// SPDX-License-Identifier: GPL-2.0-or-later
// A module of a board: the registers that it needs, its pins, and its work in a cycle.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "drivers/mesa/hostmot2/assignment.hh"
#include "drivers/mesa/hostmot2/pins.hh"
#include "drivers/mesa/hostmot2/ports.hh"
#include "drivers/mesa/hostmot2/registers.hh"

namespace mw::mesa {

/// Data of a cycle for all modules.
struct Cycle {
    double period_s = 0.001;
    bool fresh = false;           ///< the inputs are from this cycle
    bool has_lost_write = false;  ///< in read(): a write since the last read() may not have reached the board
    bool writing = false;         ///< in write(): requested registers are sent
    std::int64_t now_ns = 0;      ///< time of any clock
};

class Module {
  public:
    virtual ~Module() = default;

    /// True if it reports positions that are valid only while the driver follows the board: counts since a
    /// start, revolutions of an absolute encoder. [servo thread]
    virtual bool isCounting() const noexcept { return false; }
    /// True if it was moving something without a measured position, so that a bite of the watchdog loses the
    /// position. [servo thread]
    virtual bool isMovingUnmeasured() const noexcept { return false; }
    /// The counters of the board start again: the next read does not change the position, and counts from
    /// there. [servo thread]
    virtual void restart() noexcept {}

    /// Reads data that it needs before it creates its pins. [while loading]
    virtual Result<> prepare(RegisterBus &bus) {
        (void)bus;
        return {};
    }
    /// Names the registers that it reads and writes. [while loading]
    virtual void plan(Registers &registers) = 0;
    /// Creates its pins. [while loading]
    virtual void declare(PinSpace &space) = 0;
    /// Adds its interfaces for other components. [while loading]
    virtual void add_ports(Ports &ports) { (void)ports; }
    /// True if a user starts transfers of encoders with trigger(). [while loading]
    virtual bool hasTrigger() const noexcept { return false; }
    /// Starts the transfers of encoders with the next write. [servo thread]
    virtual void trigger() noexcept {}
    /// True once after a user has requested the state of the board for the log. [servo thread]
    virtual bool take_dump_request() noexcept { return false; }
    /// Reads the registers of this cycle; called when all are new. [servo thread]
    virtual void read(const Registers &registers, const Cycle &cycle) noexcept = 0;
    /// Sets the registers to write. After a failed read it is called without read(). [servo thread]
    virtual void write(Registers &registers, const Cycle &cycle) noexcept = 0;
    /// Writes a message about an event to `text` and returns its length, once for each event; 0: no event.
    /// [servo thread]
    virtual std::size_t take_message(std::span<char> text) noexcept {
        (void)text;
        return 0;
    }
};

/// Parameters for creating a module.
struct ModuleRequest {
    const UsedModule &module;
    const Assignment &assignment;
    const Config &config;
    const Idrom &idrom;
};

/// The module of a descriptor; null for modules served by other parts (IO ports, watchdog).
std::unique_ptr<Module> make_module(const ModuleRequest &request);

}  // namespace mw::mesa
