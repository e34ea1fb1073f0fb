// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/memory_killer.hh"

#include <fcntl.h>
#include <unistd.h>

#include <string>

namespace mw {

bool set_oom_score(int score) {
    const int file = ::open("/proc/self/oom_score_adj", O_WRONLY | O_CLOEXEC);
    if (file < 0) {
        return false;
    }
    const std::string text = std::to_string(score);
    const bool isWritten = ::write(file, text.data(), text.size()) == static_cast<ssize_t>(text.size());
    ::close(file);
    return isWritten;
}

}  // namespace mw
