// SPDX-License-Identifier: BSD-3-Clause
#include "scene/settings.hpp"

#include <algorithm>

namespace carrom {

const Setting* Settings::find(std::string_view key) const {
    for (const Setting& setting : settings_)
        if (setting.key == key) return &setting;
    return nullptr;
}

void Settings::set(Setting setting) {
    remove(setting.key);
    mention(setting.key);
    settings_.push_back(std::move(setting));
}

void Settings::remove(std::string_view key) {
    settings_.erase(std::remove_if(settings_.begin(), settings_.end(),
                                   [key](const Setting& s) { return s.key == key; }),
                    settings_.end());
}

bool Settings::is_mentioned(std::string_view key) const {
    return std::find(mentioned_.begin(), mentioned_.end(), key) != mentioned_.end();
}

} // namespace carrom
