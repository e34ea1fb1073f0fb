// SPDX-License-Identifier: GPL-2.0-or-later
#include "task_campaign/after_stop.hh"

#include <algorithm>

namespace mw::task_campaign {

std::optional<World> carried_out(const std::vector<Line> &lines, World world, bool isBlockDelete,
                                 std::size_t from) {
    for (std::size_t i = 0; i < lines.size(); ++i) {
        const bool isMove = lines[i].kind == Kind::RAPID || lines[i].kind == Kind::FEED;
        const bool isMade = !isMove || i + 1 >= from;  // what is only calculated meets no limit
        if (!apply(lines[i], world, isBlockDelete) && isMade) {
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
