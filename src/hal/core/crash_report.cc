// SPDX-License-Identifier: GPL-2.0-or-later
// Everything called by on_crash() is async-signal-safe: no heap, no locks, no stdio.
#include "hal/core/crash_report.hh"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <csignal>
#include <cstring>
#include <string_view>

#include "hal/core/detail/context.hh"
#include "hal/core/detail/thread_runner.hh"
#include "hal/core/instance.hh"
#include "runtime/alternate_stack.hh"

namespace mw::hal {

using namespace detail;

namespace {

struct Fatal {
    int number;
    const char *name;
    const char *meaning;
};

constexpr std::array<Fatal, 5> FATAL = {{{SIGSEGV, "SIGSEGV", "access to an invalid memory address"},
                                         {SIGBUS, "SIGBUS", "access to an invalid memory address"},
                                         {SIGFPE, "SIGFPE", "division of an integer by zero"},
                                         {SIGILL, "SIGILL", "an invalid instruction"},
                                         {SIGABRT, "SIGABRT", "abort()"}}};
constexpr std::size_t MOST_LEFTOVERS = 4;

/// Data for the signal handler, which can only use static memory. Set before the handlers.
struct Prepared {
    std::array<char, 64> program{};
    std::array<std::array<char, 256>, MOST_LEFTOVERS> leftovers{};
    std::array<struct sigaction, FATAL.size()> before{};
};
Prepared prepared;
std::atomic<bool> reported{false};

/// A text of bounded length.
struct Text {
    std::array<char, END_TEXT> bytes{};
    std::size_t size = 0;

    Text &operator<<(const char *text) noexcept {
        while (*text != '\0' && size + 2 < bytes.size()) {
            bytes[size++] = *text++;
        }
        return *this;
    }
};

void tell_place(Text &text, const ThreadContext &here) noexcept {
    const bool in_function = here.calling != nullptr && here.thread != nullptr;
    if (in_function) {
        const Segment &segment = here.thread->segment;
        const auto *funct = segment.at<FunctRecord>(here.calling->funct);
        const auto *comp = funct == nullptr ? nullptr : segment.at<CompRecord>(funct->comp);
        text << "function '" << (funct == nullptr ? "?" : funct->name.data()) << "' of component '"
             << (comp == nullptr ? "?" : comp->name.data()) << "' crashed in thread '"
             << here.thread->record.name.data() << "'";
    } else if (here.loading != nullptr) {
        text << "module '" << here.loading << "' crashed while it was loaded";
    } else if (here.unloading != nullptr) {
        text << "module '" << here.unloading << "' crashed while it was unloaded";
    } else if (here.doing != nullptr) {
        text << here.doing << " crashed";
    } else {
        text << "it crashed outside of any component";
    }
}

void on_crash(int number, siginfo_t *info, void * /*context*/) {
    const auto fatal =
        std::find_if(FATAL.begin(), FATAL.end(), [number](const Fatal &one) { return one.number == number; });
    // If several threads crash at once, only the first one reports.
    if (fatal != FATAL.end() && !reported.exchange(true)) {
        const ThreadContext &here = context();
        Text text;
        tell_place(text, here);
        text << ": " << fatal->meaning << " (" << fatal->name << ")";
        Instance *hal = current();
        if (hal != nullptr) {
            hal->host_status().note_end(text.bytes.data());
        }
        Text line;
        line << prepared.program.data() << ": " << text.bytes.data() << "\n";
        (void)!::write(STDERR_FILENO, line.bytes.data(), line.size);
        for (const auto &path : prepared.leftovers) {
            if (path[0] != '\0') {
                ::unlink(path.data());
            }
        }
    }
    if (fatal != FATAL.end()) {
        ::sigaction(number, &prepared.before[static_cast<std::size_t>(fatal - FATAL.begin())], nullptr);
    }
    // After the handler returns, a fault occurs again and ends the process. A signal from kill() does not, so
    // it is sent again.
    if (info->si_code <= 0) {
        ::raise(number);
    }
}

template <std::size_t SIZE>
void copy(std::array<char, SIZE> &to, std::string_view from) noexcept {
    // A path that does not fit is omitted, not cut.
    const std::size_t length = from.size() < SIZE ? from.size() : 0;
    std::memcpy(to.data(), from.data(), length);
    to[length] = '\0';
}

}  // namespace

void set_activity(const char *activity) noexcept {
    context().doing = activity;
}

void report_crashes(const std::string &program, const std::vector<std::string> &leftovers) {
    static const runtime::AlternateStack stack_of_this_thread;
    copy(prepared.program, program);
    for (std::size_t i = 0; i < std::min(leftovers.size(), MOST_LEFTOVERS); ++i) {
        copy(prepared.leftovers[i], leftovers[i]);
    }
    for (std::size_t i = 0; i < FATAL.size(); ++i) {
        struct sigaction action{};
        action.sa_sigaction = &on_crash;
        action.sa_flags = SA_SIGINFO | SA_ONSTACK;
        struct sigaction now{};
        ::sigaction(FATAL[i].number, nullptr, &now);
        const bool own = (now.sa_flags & SA_SIGINFO) != 0 && now.sa_sigaction == &on_crash;
        if (!own) {
            ::sigaction(FATAL[i].number, &action, &prepared.before[i]);
        }
    }
}

}  // namespace mw::hal
