// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/capabilities.hh"

#include <linux/capability.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>

namespace mw {
namespace {

constexpr int BITS = 32;

struct Sets {
    __user_cap_header_struct header{_LINUX_CAPABILITY_VERSION_3, 0};
    std::array<__user_cap_data_struct, _LINUX_CAPABILITY_U32S_3> data{};

    bool read() { return ::syscall(SYS_capget, &header, data.data()) == 0; }
    void write() { static_cast<void>(::syscall(SYS_capset, &header, data.data())); }
};

}  // namespace

std::uint64_t effective_capabilities() {
    Sets sets;
    return sets.read() ? sets.data[0].effective | std::uint64_t{sets.data[1].effective} << BITS : 0;
}

void use_permitted_capabilities() {
    Sets sets;
    if (sets.read()) {
        for (auto &set : sets.data) {
            set.effective = set.permitted;
        }
        sets.write();
    }
}

void give_up_capability(int capability) {
    Sets sets;
    if (sets.read()) {
        auto &set = sets.data[static_cast<std::size_t>(capability / BITS)];
        const std::uint32_t others = ~(1U << (capability % BITS));
        set.effective &= others;
        set.permitted &= others;
        set.inheritable &= others;
        sets.write();
    }
}

}  // namespace mw
