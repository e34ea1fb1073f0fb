// SPDX-License-Identifier: GPL-2.0-or-later
// Lines by the character devices /dev/gpiochipN, version 2 of their interface (Linux 5.10).
#pragma once

#include "drivers/gpio/lines.hh"

namespace mw::gpio {

/// The system calls used here; tests replace them. All return as the calls do, with errno.
class System {
  public:
    virtual int open(const char *path) noexcept = 0;
    virtual int control(int file, unsigned long request, void *argument) noexcept = 0;
    virtual void close(int file) noexcept = 0;

  protected:
    ~System() = default;
};

System &linux_system() noexcept;

class CharacterDevice final : public LineAccess {
  public:
    explicit CharacterDevice(System &system) noexcept : system_(&system) {}

    int open(const char *module, const Lines &lines) noexcept override;
    bool read(Levels &levels) noexcept override;
    bool write(Levels levels) noexcept override;
    void close() noexcept override;

  private:
    static constexpr std::size_t MAX_CHIPS = 16;

    /// The lines of one chip and one direction, which the kernel reads or writes with one call.
    struct Group {
        int file = -1;
        Direction direction = Direction::INPUT;
        std::size_t count = 0;
        std::uint8_t line[MAX_LINES] = {};  ///< number in the component, for each line of the group
    };
    /// Location of a line.
    struct Place {
        bool found = false;
        std::size_t chip = 0;
        std::uint32_t offset = 0;
    };

    int find(const Lines &lines, Place *places) noexcept;
    void find_in_chip(int file, std::size_t chip, const Lines &lines, Place *places) noexcept;
    int request(const char *module, const Lines &lines, const Place *places, std::size_t chip,
                Direction direction) noexcept;

    System *system_;
    int chips_[MAX_CHIPS] = {};
    std::size_t num_chips_ = 0;
    Group group_[2 * MAX_CHIPS];
    std::size_t num_groups_ = 0;
};

}  // namespace mw::gpio
