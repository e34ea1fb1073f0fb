// SPDX-License-Identifier: GPL-2.0-or-later
// One parallel port: converts levels of pins to registers and back.
#pragma once

#include <cstdint>

#include "drivers/parport/access.hh"
#include "drivers/parport/lines.hh"

namespace mw::parport {

/// Levels of up to MAX_LINES pins, bit i for line i of outputs_of() or inputs_of().
using Levels = std::uint32_t;

/// Writes registers only when they change. [servo or base thread; no allocation]
class Port {
  public:
    /// Selects the directions and sets the first levels of the outputs. [while loading]
    void begin(PortAccess &access, Mode mode, Levels levels) noexcept {
        access_ = &access;
        outputs_ = outputs_of(mode);
        inputs_ = inputs_of(mode);
        base_ = control_base(mode);
        for (const Line &line : inputs_.all()) {
            has_inputs_[static_cast<std::size_t>(line.reg)] = true;
        }
        access.select(mode);
        const Bytes bytes = bytes_of(levels);
        write(bytes, true);
    }

    Levels read() noexcept {
        std::uint8_t bytes[3] = {};
        for (std::size_t reg = 0; reg < 3; ++reg) {
            bytes[reg] = has_inputs_[reg] ? access_->read(static_cast<Register>(reg)) : std::uint8_t{0};
        }
        Levels levels = 0;
        for (std::size_t i = 0; i < inputs_.count; ++i) {
            const Line &line = inputs_.line[i];
            const bool high = ((bytes[static_cast<std::size_t>(line.reg)] & line.mask) != 0) != line.inverted;
            levels |= high ? Levels{1} << i : 0U;
        }
        return levels;
    }

    void write(Levels levels) noexcept { write(bytes_of(levels), false); }

    /// Sets the data pins of `mask` to `levels`; other pins do not change. The next write() writes all
    /// registers again.
    void reset(Levels mask, Levels levels) noexcept {
        std::uint8_t data = last_.data;
        for (std::size_t i = 0; i < outputs_.count; ++i) {
            const Line &line = outputs_.line[i];
            if (line.reg != Register::DATA || (mask & (Levels{1} << i)) == 0) {
                continue;
            }
            const bool high = (levels & (Levels{1} << i)) != 0;
            data = high ? static_cast<std::uint8_t>(data | line.mask)
                        : static_cast<std::uint8_t>(data & ~line.mask);
        }
        write(Bytes{.data = data, .control = last_.control}, false);
    }

    const Lines &outputs() const noexcept { return outputs_; }
    const Lines &inputs() const noexcept { return inputs_; }

  private:
    struct Bytes {
        std::uint8_t data = 0, control = 0;
    };

    Bytes bytes_of(Levels levels) const noexcept {
        Bytes bytes{.data = 0, .control = base_};
        for (std::size_t i = 0; i < outputs_.count; ++i) {
            const Line &line = outputs_.line[i];
            if (((levels & (Levels{1} << i)) != 0) == line.inverted) {
                continue;
            }
            std::uint8_t &byte = line.reg == Register::DATA ? bytes.data : bytes.control;
            byte = static_cast<std::uint8_t>(byte | line.mask);
        }
        return bytes;
    }
    void write(const Bytes &bytes, bool all) noexcept {
        if (all || bytes.data != last_.data) {
            access_->write(Register::DATA, bytes.data);
        }
        if (all || bytes.control != last_.control) {
            access_->write(Register::CONTROL, bytes.control);
        }
        last_ = bytes;
    }

    PortAccess *access_ = nullptr;
    Lines outputs_, inputs_;
    bool has_inputs_[3] = {};  ///< for each register
    std::uint8_t base_ = 0;
    Bytes last_;
};

}  // namespace mw::parport
