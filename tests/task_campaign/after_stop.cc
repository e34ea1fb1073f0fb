// SPDX-License-Identifier: GPL-2.0-or-later
#include "task_campaign/after_stop.hh"

#include <algorithm>

namespace mw::task_campaign {

std::optional<World> carried_out(const std::vector<Line> &lines, World world, bool isBlockDelete) {
    for (const Line &line : lines) {
        if (!apply(line, world, isBlockDelete)) {
            return std::nullopt;
        }
    }
    end_program(world);
    return world;
}

std::vector<World> after_stop(const std::vector<Line> &lines, const World &before, bool isBlockDelete) {
    std::vector<World> prefixes{before};
    World world = before;
    for (const Line &line : lines) {
        apply(line, world, isBlockDelete);
        prefixes.push_back(world);
    }
    end_program(world);
    prefixes.push_back(world);
    std::vector<Doings> doings;
    std::vector<World> all;
    for (const World &read : prefixes) {
        World done = read;
        switch_devices_off(done);
        done.doings.at = {};
        if (std::ranges::find(doings, done.doings) == doings.end()) {
            doings.push_back(done.doings);
        }
        for (const Doings &one : doings) {
            add(all, {read.modes, one});
        }
    }
    return all;
}

std::vector<World> with_or_without(const Line &line, const World &before) {
    World after = before;
    apply(line, after, false);
    std::vector<World> all;
    for (World world : {before, after, World{after.modes, before.doings}}) {
        switch_devices_off(world);
        add(all, world);
    }
    return all;
}

}  // namespace mw::task_campaign
