// SPDX-License-Identifier: BSD-3-Clause
#include "run/start/scene_source.hpp"

#include <filesystem>
#include <fstream>
#include <sstream>
#include <utility>

#include <fmt/format.h>

#include "initial_state/scene_input.hpp"
#include "io/checkpoint.hpp"
#include "io/checkpoint_folder.hpp"
#include "io/files.hpp"
#include "parallel/agreement.hpp"
#include "parallel/slabs.hpp"
#include "run/files/run_folder.hpp"
#include "scene/disc_columns.hpp"
#include "scene/disc_file.hpp"
#include "scene/disc_reader.hpp"
#include "scene/effects/effect.hpp"
#include "stored_scene/discs_from.hpp"

namespace carrom {

namespace {

using Problems = std::vector<Problem>;

/// Calls `read`, and returns the problems of the InputError that it throws, if any. Rank 0 may find
/// problems that the other ranks do not, so no rank may throw before all ranks have agreed.
template <class Read> Problems problems_of(const Read& read) {
    try {
        read();
    } catch (const InputError& error) {
        return error.problems();
    }
    return {};
}

/// Whether discs come from `discs.from`. A scene that also has a file or a list of discs is an
/// error; then no discs are read, because it is unknown which ones are meant.
bool takes_discs_from(const SceneParameters& scene) {
    return !scene.discs_from.empty() && scene.discs_file.empty() && scene.listed_discs.empty();
}
bool takes_discs_of_file(const SceneParameters& scene) {
    return !scene.discs_file.empty() && scene.discs_from.empty() && scene.listed_discs.empty();
}

/// The error text for a file whose number of discs is not `n_wanted`.
std::string other_number(const FileOfDiscs& file, std::uint64_t n_wanted) {
    std::string text = fmt::format("has {} disc{}", file.n_discs, file.n_discs == 1 ? "" : "s");
    if (!file.departed.empty())
        text += fmt::format(" in the box, and {} that departed by an open side",
                            file.departed.size());
    if (!file.departed.empty() && !file.n_by_species.empty())
        text += fmt::format(" (in the box of each species: {})",
                            fmt::join(file.n_by_species, ", "));
    return text + fmt::format(", and the scene is of {}", n_wanted);
}

/// A warning that discs have departed and the others have new ids.
std::string note_on_departed(const std::string& path, const FileOfDiscs& file) {
    return fmt::format("{} of {} discs in {} departed by an open side and are left out; the others "
                       "have the ids 0 to {} here, in their order",
                       file.departed.size(), file.n_discs + file.departed.size(), path,
                       file.n_discs - 1);
}

/// The settings and the warning that `discs.from` adds to a scene; the same on every rank.
struct FromFile {
    std::vector<std::string> settings;
    std::string warning; ///< empty if the scene contains all discs of the file
    double radius = 0;   ///< radius of the largest disc in the file
};

/// Text to append to the warning of departed discs, if discs.packing makes the remaining discs
/// larger than they are in the file; otherwise empty.
std::string note_on_radius(const SceneParameters& scene, const FromFile& from) {
    if (!(scene.radius > from.radius * (1 + 1e-9))) return {};
    const std::string remedy = scene.sizes ? "discs.radius.mean"
                                           : fmt::format("discs.radius = {}", from.radius);
    return fmt::format("; discs.packing gives these fewer discs {} {:.10g}, and in the file it is "
                       "{:.10g}; try: {} in place of discs.packing",
                       scene.sizes ? "a largest radius of" : "the radius", scene.radius,
                       from.radius, remedy);
}

/// Throws if the path is a folder. This is an easy mistake, so the error names a likely file.
/// **Collective.**
void refuse_folder(const SceneParameters& scene, const std::string& path,
                   const Communicator& ranks) {
    namespace fs = std::filesystem;
    on_root(ranks, path, ExitCode::bad_input, [&] {
        std::error_code ignored;
        if (!fs::is_directory(path, ignored)) return;
        std::vector<FoundFile> found = find_checkpoints(checkpoints_of_run(path));
        if (found.empty()) found = find_checkpoints(path);
        std::string text = "is a folder, and 'discs.from' takes a checkpoint or a trajectory";
        if (!found.empty())
            text += fmt::format(
                "; try: discs.from = \"{}\"",
                (fs::path(scene.discs_from) / fs::path(found.front().path).lexically_relative(path))
                    .string());
        throw FileError(text);
    });
}

/// Writes the discs of `discs.from` as lines of text into `stream`, as if they followed the scene's
/// text: all discs on rank 0, and on each other rank its share. **Collective.**
FromFile follow_with_discs_from(const SceneParameters& scene, std::unique_ptr<std::istream>& stream,
                                Problems& of_root, const Communicator& ranks) {
    const std::string path = discs_path(scene);
    refuse_folder(scene, path, ranks);
    check_damage(path, ranks);
    SideColumnSet wanted = side_columns_of(scene.effects);
    for (const SideColumn column : all_side_columns)
        if (!info_of(column).is_of_dynamics) wanted.add(column);
    FileOfDiscs file;
    if (ranks.is_root()) {
        append(of_root, problems_of([&] {
                   file = read_discs_from(path, scene.discs_from_step, wanted, scene.origin);
                   if (scene.n_discs != 0 && scene.n_discs != file.n_discs)
                       throw InputError({{path, 0, other_number(file, scene.n_discs)}});
               }));
        stream = std::move(file.lines);
        if (!stream) stream = std::make_unique<std::istringstream>();
    }
    ranks.broadcast(file.n_discs);
    ranks.broadcast(file.columns);
    ranks.broadcast(file.departed);
    ranks.broadcast(file.radius);
    // errors are ignored here, because rank 0 reads all lines and finds them, too
    if (!ranks.is_root() && file.n_discs > 0)
        problems_of([&] {
            const Slab share = slab_of_rank(ranks.rank(), file.n_discs, ranks.size());
            stream = read_discs_from(path, scene.discs_from_step, wanted, scene.origin,
                                     ShareOfDiscs{share, file.departed})
                         .lines;
        });
    FromFile from;
    std::vector<std::string>& settings = from.settings;
    if (file.n_discs > 0 && scene.n_discs == 0) // a scene with its own discs.count keeps it
        settings.push_back(fmt::format("discs.count={}", file.n_discs));
    if (!file.columns.empty()) settings.push_back("discs.columns=" + file.columns);
    if (!file.departed.empty()) from.warning = note_on_departed(path, file);
    from.radius = file.radius;
    return from;
}

std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> all;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) all.push_back(line);
    return all;
}

/// Returns settings for the columns and the number of discs of the file of discs, the same on every
/// rank. A file that cannot be opened is reported here only if its number of discs is needed;
/// otherwise another function reports it. **Collective.**
std::vector<std::string> settings_of_file(const SceneParameters& scene, Problems& of_root,
                                          const Communicator& ranks) {
    std::string all;
    if (ranks.is_root()) {
        SurveyOfDiscs survey;
        const Problems unreadable = problems_of([&] {
            std::ifstream file = open_input(discs_path(scene));
            survey = survey_discs(file, scene);
        });
        append(of_root, survey.problems);
        if (scene.n_discs == 0) append(of_root, unreadable);
        for (const std::string& setting : survey.settings) all += setting + '\n';
    }
    ranks.broadcast(all);
    return lines_of(all);
}

/// The settings from files of effects, the same on every rank. **Collective.**
std::vector<std::string> settings_of_effects(const SceneParameters& scene, Problems& of_root,
                                             const Communicator& ranks) {
    std::string all;
    if (ranks.is_root())
        append(of_root, problems_of([&] {
                   for (const std::string& setting : settings_of_effect_files(scene))
                       all += setting + '\n';
               }));
    ranks.broadcast(all);
    return lines_of(all);
}

} // namespace

SceneParameters read_with_files(SceneSource& source, std::vector<std::string> settings,
                                Problems& problems, Problems& of_root, const Communicator& ranks) {
    Problems found;
    SceneParameters scene;
    const auto read_again = [&] {
        found.clear();
        scene = read_scene(source.text, settings, found);
    };
    read_again();
    FromFile from;
    if (takes_discs_from(scene)) {
        from = follow_with_discs_from(scene, source.stream, of_root, ranks);
        settings.insert(settings.end(), from.settings.begin(), from.settings.end());
        source.text.discs_follow = true;
        if (!from.settings.empty()) read_again();
    }
    if (takes_discs_of_file(scene)) {
        const std::vector<std::string> of_file = settings_of_file(scene, of_root, ranks);
        settings.insert(settings.end(), of_file.begin(), of_file.end());
        if (!of_file.empty()) read_again();
    }
    const std::vector<std::string> of_effects = settings_of_effects(scene, of_root, ranks);
    settings.insert(settings.end(), of_effects.begin(), of_effects.end());
    if (!of_effects.empty()) read_again();
    const bool has_file = takes_discs_of_file(scene) || takes_discs_from(scene);
    if (has_columns_beside(scene) && has_file) {
        source.text.columns = load_columns(scene, source.stream.get(), ranks);
        read_again();
    }
    append(problems, found);
    if (!from.warning.empty()) scene.warnings.push_back(from.warning + note_on_radius(scene, from));
    return scene;
}

SceneParameters read_with_files(SceneSource& source, const std::vector<std::string>& settings,
                                const Communicator& ranks) {
    Problems same_everywhere, problems;
    SceneParameters scene = read_with_files(source, settings, same_everywhere, problems, ranks);
    if (ranks.is_root()) {
        append(problems, same_everywhere);
        if (are_columns_wrong(source)) {
            append(problems, disc_line_problems_of(scene, source.stream.get()));
            if (problems.empty())
                problems.push_back({discs_path(scene), 0, "changes while it is being read"});
        }
    }
    agree_on_problems(ranks, problems);
    return scene;
}

bool are_columns_wrong(const SceneSource& source) {
    return source.text.columns && !source.text.columns->is_whole;
}

Problems disc_line_problems_of(const SceneParameters& scene, std::istream* stream) {
    Problems problems;
    const bool is_known = takes_discs_of_file(scene) && scene.n_discs == 0;
    if (is_known) return problems; // already reported, because the lines could not be counted
    append(problems, problems_of([&] {
               if (!scene.reads_disc_lines()) return;
               if (takes_discs_of_file(scene)) {
                   std::ifstream file = open_input(discs_path(scene));
                   if (!survey_discs(file, scene).problems.empty()) return; // reported before
                   file.clear();
                   file.seekg(0);
                   problems = disc_line_problems(file, scene);
               } else if (stream && scene.discs_follow && scene.discs_file.empty()) {
                   problems = disc_line_problems(*stream, scene);
               }
           }));
    return problems;
}

} // namespace carrom
