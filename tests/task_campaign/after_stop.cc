// SPDX-License-Identifier: GPL-2.0-or-later
#include "task_campaign/after_stop.hh"

#include <algorithm>

namespace mw::task_campaign {

std::optional<World> carried_out(const std::vector<Line> &lines, World world, bool isBlockDelete,
                                 std::size_t from) {
    for (std::size_t i = 0; i < lines.size(); ++i) {
        const bool isMove = lines[i].kind == Kind::RAPID || lines[i].kind == Kind::FEED;
        const bool isMade = !isMove || i + 1 >= from;  // a calculated path has no limits
        if (!apply(lines[i], world, isBlockDelete) && isMade) {
            return std::nullopt;
        }
    }
    end_program(world);
    return world;
}

std::vector<World> after_stop(const std::vector<Line> &lines, const World &before, bool isBlockDelete,
                              std::size_t from) {
    std::vector<World> prefixes{before};
    for (const Line &line : lines) {
        World after = prefixes.back();
        apply(line, after, isBlockDelete);
        prefixes.push_back(after);
    }
    prefixes.push_back(prefixes.back());
    end_program(prefixes.back());
    std::vector<World> all;
    for (std::size_t i = from > 0 ? from - 1 : 0; i < prefixes.size(); ++i) {
        const std::size_t first = from > 0 || i == 0 ? 0 : i - 1;
        for (std::size_t done = first; done <= i; ++done) {
            World stopped{prefixes[i].modes, prefixes[done].doings};
            switch_devices_off(stopped);
            stopped.doings.at = {};
            add(all, stopped);
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
