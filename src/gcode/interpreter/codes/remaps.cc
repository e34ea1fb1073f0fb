// SPDX-License-Identifier: GPL-2.0-or-later
#include "gcode/interpreter/codes/remaps.hh"

#include <algorithm>
#include <cctype>

#include <fmt/format.h>

namespace mw::gcode::detail {

Result<> Remaps::load(std::span<const RemapLine> lines) {
    all_.clear();
    refused_.clear();
    for (const RemapLine &line : lines) {
        Result<Remap> made = parse_remap(line);
        if (!made) {
            return std::unexpected(made.error());
        }
        if (!made->refusal.empty()) {
            refused_.push_back(std::move(made->refusal));
            continue;
        }
        for (const Remap &other : all_) {
            if (other.code.id == made->code.id) {
                return fail(fmt::format("REMAP={}: {} is remapped twice", line.text, made->name), line.place);
            }
        }
        all_.push_back(std::move(*made));
    }
    for (Remap &remap : all_) {
        remap.code.remap = &remap;
    }
    return {};
}

bool Remaps::isRunning(const Remap &remap) const {
    return std::ranges::any_of(running_,
                               [&remap](const Running &running) { return running.remap == &remap; });
}

const Code *Remaps::find(GCode code) const {
    for (const Remap &remap : all_) {
        if (remap.code.id == code && !isRunning(remap)) {
            return &remap.code;
        }
    }
    return nullptr;
}

void Remaps::end_above(std::size_t level) {
    while (!running_.empty() && running_.back().level > level) {
        running_.pop_back();
    }
}

void Remaps::count_builtin(GCode code) {
    for (Running &running : running_) {
        if (running.remap->code.id == code) {
            ++running.builtins;
        }
    }
}

std::string Remaps::recursion_text(GCode code) const {
    for (const Running &running : running_) {
        const Remap &remap = *running.remap;
        if (remap.code.id == code) {
            return fmt::format("{} is used in its own procedure, but it only has the remapped meaning",
                               remap.name);
        }
    }
    return {};
}

PendingBlock Remaps::take_interrupted() {
    PendingBlock out = std::move(*interrupted_);
    interrupted_.reset();
    return out;
}

std::string missing_words(const PendingBlock &block, const State &state) {
    std::string missing;
    const auto add = [&missing](std::string_view what) {
        missing += missing.empty() ? "" : ",";
        missing += what;
    };
    for (const RemapWord &word : block.remap->words) {
        if (word.required && !block.values.has(word.letter)) {
            const char upper = static_cast<char>(std::toupper(word.letter));
            add({&upper, 1});
        }
    }
    if (block.remap->needs_feed && state.feed <= 0.0) {
        add("F>0");
    }
    if (block.remap->needs_speed && state.spindles[0].speed <= 0.0) {
        add("S>0");
    }
    return missing;
}

void pass_words(const PendingBlock &block, bool count_named, Parameters &parameters, Names &names) {
    const Remap &remap = *block.remap;
    for (int i = 1; i <= ARGUMENT_COUNT; ++i) {
        parameters.set(i, 0.0);
    }
    int position = 0;
    for (const RemapWord &word : remap.words) {
        if (!block.values.has(word.letter)) {
            continue;
        }
        const double value = block.values.at(word.letter);
        if (remap.positional) {
            parameters.set(++position, value);
        } else {
            parameters.set_named(names.intern(std::string(1, word.letter)), false, value);
        }
    }
    if (remap.wants_line) {
        parameters.set_named(names.intern("n"), false, block.line);
    }
    if (count_named && remap.positional) {
        parameters.set_named(names.intern("n_args"), false, position);
    }
    parameters.commit();
}

}  // namespace mw::gcode::detail
