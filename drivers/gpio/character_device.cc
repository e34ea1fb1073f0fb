// SPDX-License-Identifier: GPL-2.0-or-later
#include "drivers/gpio/character_device.hh"

#include <fcntl.h>
#include <linux/gpio.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "rtapi.h"

namespace mw::gpio {

namespace {

class LinuxSystem final : public System {
  public:
    int open(const char *path) noexcept override { return ::open(path, O_RDWR | O_CLOEXEC); }
    int control(int file, unsigned long request, void *argument) noexcept override {
        return ::ioctl(file, request, argument);
    }
    void close(int file) noexcept override { ::close(file); }
};

std::uint64_t flags_of(const Line &line) noexcept {
    std::uint64_t flags =
        line.direction == Direction::INPUT ? GPIO_V2_LINE_FLAG_INPUT : GPIO_V2_LINE_FLAG_OUTPUT;
    flags |= line.inverted ? GPIO_V2_LINE_FLAG_ACTIVE_LOW : 0;
    switch (line.drive) {
    case Drive::PUSH_PULL: break;
    case Drive::OPEN_DRAIN: flags |= GPIO_V2_LINE_FLAG_OPEN_DRAIN; break;
    case Drive::OPEN_SOURCE: flags |= GPIO_V2_LINE_FLAG_OPEN_SOURCE; break;
    }
    switch (line.bias) {
    case Bias::AS_IS: break;
    case Bias::DISABLED: flags |= GPIO_V2_LINE_FLAG_BIAS_DISABLED; break;
    case Bias::PULL_DOWN: flags |= GPIO_V2_LINE_FLAG_BIAS_PULL_DOWN; break;
    case Bias::PULL_UP: flags |= GPIO_V2_LINE_FLAG_BIAS_PULL_UP; break;
    }
    return flags;
}

/// Sets the flags of the line at `index`: an attribute for each set of flags that occurs. False if there are
/// too many sets.
bool add_flags(gpio_v2_line_config &config, std::uint64_t flags, std::size_t index) noexcept {
    for (std::uint32_t i = 0; i < config.num_attrs; ++i) {
        if (config.attrs[i].attr.flags == flags) {
            config.attrs[i].mask |= bit_of(index);
            return true;
        }
    }
    if (config.num_attrs == GPIO_V2_LINE_NUM_ATTRS_MAX) {
        return false;
    }
    gpio_v2_line_config_attribute &attribute = config.attrs[config.num_attrs];
    attribute.attr.id = GPIO_V2_LINE_ATTR_ID_FLAGS;
    attribute.attr.flags = flags;
    attribute.mask = bit_of(index);
    ++config.num_attrs;
    return true;
}

}  // namespace

System &linux_system() noexcept {
    static LinuxSystem system;
    return system;
}

int CharacterDevice::open(const char *module, const Lines &lines) noexcept {
    Place places[MAX_LINES];
    if (const int status = find(lines, places); status != 0) {
        rtapi_print_msg(
            RTAPI_MSG_ERR,
            "%s: there is no GPIO chip (/dev/gpiochip0), or this user may not open it: errno %d\n", module,
            -status);
        return status;
    }
    for (std::size_t i = 0; i < lines.count; ++i) {
        if (!places[i].found) {
            rtapi_print_msg(RTAPI_MSG_ERR, "%s: no GPIO chip has a line '%s'; gpioinfo lists the names\n",
                            module, lines.line[i].name);
            return -ENOENT;
        }
    }
    for (std::size_t chip = 0; chip < num_chips_; ++chip) {
        for (const Direction direction : {Direction::INPUT, Direction::OUTPUT}) {
            if (const int status = request(module, lines, places, chip, direction); status != 0) {
                return status;
            }
        }
    }
    return 0;
}

int CharacterDevice::find(const Lines &lines, Place *places) noexcept {
    int error = ENODEV;
    for (std::size_t chip = 0; chip < MAX_CHIPS; ++chip) {
        char path[NAME_SIZE];
        rtapi_snprintf(path, sizeof path, "/dev/gpiochip%u", static_cast<unsigned>(chip));
        const int file = system_->open(path);
        if (file < 0) {
            error = errno == ENOENT ? error : errno;
            continue;
        }
        chips_[num_chips_] = file;
        find_in_chip(file, num_chips_, lines, places);
        ++num_chips_;
    }
    return num_chips_ == 0 ? -error : 0;
}

void CharacterDevice::find_in_chip(int file, std::size_t chip, const Lines &lines, Place *places) noexcept {
    gpiochip_info info{};
    if (system_->control(file, GPIO_GET_CHIPINFO_IOCTL, &info) != 0) {
        return;
    }
    for (std::uint32_t offset = 0; offset < info.lines; ++offset) {
        gpio_v2_line_info found{};
        found.offset = offset;
        if (system_->control(file, GPIO_V2_GET_LINEINFO_IOCTL, &found) != 0) {
            continue;
        }
        for (std::size_t i = 0; i < lines.count; ++i) {
            if (!places[i].found && std::strncmp(found.name, lines.line[i].name, sizeof found.name) == 0) {
                places[i] = {.found = true, .chip = chip, .offset = offset};
            }
        }
    }
}

int CharacterDevice::request(const char *module, const Lines &lines, const Place *places, std::size_t chip,
                             Direction direction) noexcept {
    gpio_v2_line_request wanted{};
    Group &group = group_[num_groups_];
    group = {};
    group.direction = direction;
    rtapi_snprintf(wanted.consumer, sizeof wanted.consumer, "%s", module);
    for (std::size_t i = 0; i < lines.count; ++i) {
        if (places[i].chip != chip || lines.line[i].direction != direction) {
            continue;
        }
        if (!add_flags(wanted.config, flags_of(lines.line[i]), group.count)) {
            rtapi_print_msg(RTAPI_MSG_ERR, "%s: the lines of one chip have more than %d different settings\n",
                            module, GPIO_V2_LINE_NUM_ATTRS_MAX);
            return -EINVAL;
        }
        wanted.offsets[group.count] = places[i].offset;
        group.line[group.count] = static_cast<std::uint8_t>(i);
        ++group.count;
    }
    if (group.count == 0) {
        return 0;
    }
    wanted.num_lines = static_cast<std::uint32_t>(group.count);
    // Outputs without values begin inactive.
    wanted.config.flags = direction == Direction::INPUT ? GPIO_V2_LINE_FLAG_INPUT : GPIO_V2_LINE_FLAG_OUTPUT;
    if (system_->control(chips_[chip], GPIO_V2_GET_LINE_IOCTL, &wanted) != 0) {
        const int error = errno;
        rtapi_print_msg(RTAPI_MSG_ERR, "%s: the kernel does not give the lines from '%s' on: errno %d%s\n",
                        module, lines.line[group.line[0]].name, error,
                        error == EBUSY ? ", another program uses one of them" : "");
        return -error;
    }
    group.file = wanted.fd;
    ++num_groups_;
    return 0;
}

bool CharacterDevice::read(Levels &levels) noexcept {
    Levels found = levels;
    for (std::size_t g = 0; g < num_groups_; ++g) {
        const Group &group = group_[g];
        if (group.direction != Direction::INPUT) {
            continue;
        }
        gpio_v2_line_values values{};
        values.mask = group.count == MAX_LINES ? ~Levels{0} : bit_of(group.count) - 1;
        if (system_->control(group.file, GPIO_V2_LINE_GET_VALUES_IOCTL, &values) != 0) {
            return false;
        }
        for (std::size_t i = 0; i < group.count; ++i) {
            const Levels line = bit_of(group.line[i]);
            found = (values.bits & bit_of(i)) != 0 ? found | line : found & ~line;
        }
    }
    levels = found;
    return true;
}

bool CharacterDevice::write(Levels levels) noexcept {
    bool written = true;
    for (std::size_t g = 0; g < num_groups_; ++g) {
        const Group &group = group_[g];
        if (group.direction != Direction::OUTPUT) {
            continue;
        }
        gpio_v2_line_values values{};
        values.mask = group.count == MAX_LINES ? ~Levels{0} : bit_of(group.count) - 1;
        for (std::size_t i = 0; i < group.count; ++i) {
            values.bits |= (levels & bit_of(group.line[i])) != 0 ? bit_of(i) : 0;
        }
        written = system_->control(group.file, GPIO_V2_LINE_SET_VALUES_IOCTL, &values) == 0 && written;
    }
    return written;
}

void CharacterDevice::close() noexcept {
    for (std::size_t g = 0; g < num_groups_; ++g) {
        system_->close(group_[g].file);
    }
    for (std::size_t chip = 0; chip < num_chips_; ++chip) {
        system_->close(chips_[chip]);
    }
    num_groups_ = 0;
    num_chips_ = 0;
}

}  // namespace mw::gpio
