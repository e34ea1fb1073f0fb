// SPDX-License-Identifier: GPL-2.0-or-later
#include "programs/run/keyboard.hh"

#include <poll.h>
#include <unistd.h>

namespace mw::programs {
namespace {

constexpr char ESCAPE = 27;

}  // namespace

bool Keyboard::isThere() {
    return ::isatty(STDIN_FILENO) == 1 && ::tcgetpgrp(STDIN_FILENO) == ::getpgrp();
}

Keyboard::Keyboard() {
    if (!isThere() || ::tcgetattr(STDIN_FILENO, &before_) != 0) {
        return;
    }
    termios keys = before_;
    keys.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
    keys.c_cc[VMIN] = 0;
    keys.c_cc[VTIME] = 0;
    keys.c_cc[VSUSP] = _POSIX_VDISABLE;
    taken_ = ::tcsetattr(STDIN_FILENO, TCSANOW, &keys) == 0;
}

Keyboard::~Keyboard() {
    // The kernel stops a background program that changes its terminal.
    if (taken_ && isThere()) {
        ::tcsetattr(STDIN_FILENO, TCSANOW, &before_);
    }
}

std::optional<char> Keyboard::read() {
    if (!taken_ || !isThere()) {
        return std::nullopt;
    }
    pollfd input{STDIN_FILENO, POLLIN, 0};
    char key = 0;
    if (::poll(&input, 1, 0) != 1 || ::read(STDIN_FILENO, &key, 1) != 1) {
        return std::nullopt;
    }
    if (key == ESCAPE) {
        ::tcflush(STDIN_FILENO, TCIFLUSH);  // discards the rest of an arrow or function key
        return std::nullopt;
    }
    return key;
}

}  // namespace mw::programs
