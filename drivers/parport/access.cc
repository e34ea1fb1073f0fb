// SPDX-License-Identifier: GPL-2.0-or-later
#include "drivers/parport/access.hh"

#include <fcntl.h>
#include <linux/parport.h>
#include <linux/ppdev.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cerrno>

#include "rtapi.h"

namespace mw::parport {

namespace {

/// Values of the ECP control register; the mode is in the three high bits.
constexpr std::uint8_t BYTE_MODE = 0x20, EPP_MODE = 0x80;

}  // namespace

int DirectAccess::open(const char *module, std::uint16_t address) noexcept {
    return rtapi_parport_get(module, &port_, address, 0, 0);
}

std::uint8_t DirectAccess::read(Register reg) noexcept {
    return rtapi_inb(static_cast<unsigned short>(port_.base + static_cast<unsigned>(reg)));
}

void DirectAccess::write(Register reg, std::uint8_t value) noexcept {
    rtapi_outb(value, static_cast<unsigned short>(port_.base + static_cast<unsigned>(reg)));
}

void DirectAccess::select(Mode mode) noexcept {
    rtapi_parport_ecr_write(&port_, mode == Mode::EPP ? EPP_MODE : BYTE_MODE);
}

void DirectAccess::release() noexcept {
    rtapi_parport_release(&port_);
}

int DeviceAccess::open(const char *module, int number) noexcept {
    char name[32];
    rtapi_snprintf(name, sizeof name, "/dev/parport%d", number);
    file_ = ::open(name, O_RDWR | O_NONBLOCK | O_CLOEXEC);
    if (file_ < 0) {
        const int error = errno;
        rtapi_print_msg(RTAPI_MSG_ERR, "%s: cannot open %s: errno %d\n", module, name, error);
        return -error;
    }
    // The port is shared. Another claim, for instance of a printer, does not end ours, but this call waits
    // for it.
    if (::ioctl(file_, PPCLAIM) != 0) {
        const int error = errno;
        rtapi_print_msg(RTAPI_MSG_ERR, "%s: cannot claim %s: errno %d\n", module, name, error);
        release();
        return -error;
    }
    return 0;
}

std::uint8_t DeviceAccess::read(Register reg) noexcept {
    unsigned char value = 0;
    ::ioctl(file_, reg == Register::DATA ? PPRDATA : (reg == Register::STATUS ? PPRSTATUS : PPRCONTROL),
            &value);
    return value;
}

void DeviceAccess::write(Register reg, std::uint8_t value) noexcept {
    unsigned char byte = value;
    ::ioctl(file_, reg == Register::DATA ? PPWDATA : PPWCONTROL, &byte);
}

void DeviceAccess::select(Mode mode) noexcept {
    int kernel_mode = mode == Mode::EPP ? IEEE1284_MODE_EPP : IEEE1284_MODE_COMPAT;
    ::ioctl(file_, PPSETMODE, &kernel_mode);
    int input = mode == Mode::IN ? 1 : 0;
    ::ioctl(file_, PPDATADIR, &input);
}

void DeviceAccess::release() noexcept {
    if (file_ >= 0) {
        ::close(file_);
        file_ = -1;
    }
}

std::uint8_t SimulatedAccess::read(Register reg) noexcept {
    const bool input = reg == Register::STATUS || (reg == Register::DATA && mode_ == Mode::IN) ||
                       (reg == Register::CONTROL && mode_ == Mode::CONTROL_IN);
    return input ? inputs_[index(reg)] : written_[index(reg)];
}

void SimulatedAccess::write(Register reg, std::uint8_t value) noexcept {
    written_[index(reg)] = value;
}

void SimulatedAccess::set_level(const Line &line, bool high) noexcept {
    std::uint8_t &byte = inputs_[index(line.reg)];
    byte = high != line.inverted ? static_cast<std::uint8_t>(byte | line.mask)
                                 : static_cast<std::uint8_t>(byte & ~line.mask);
}

bool SimulatedAccess::level(const Line &line) const noexcept {
    return ((written_[index(line.reg)] & line.mask) != 0) != line.inverted;
}

}  // namespace mw::parport
