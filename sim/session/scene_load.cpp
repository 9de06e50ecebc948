// sim/session/scene_load.cpp
// The files that a scene names: organs with their beds, painted regions, and the hash of it all.
// Called at session setup and by `trocar scene check`.
#include "sim/session/scene.h"

#include "sim/io/files.h"
#include "sim/session/rehold.h"

#include <algorithm>
#include <fmt/format.h>

namespace sim {
namespace {

using tasks::TomlTable;

void refuse_or_keep(const TomlTable& t, const char* key, const std::string& accepted,
                    Mistakes* mistakes) {
    if (!mistakes)
        t.refuse(key, accepted);
    mistakes->push_back({t.mention(key), accepted});
}

// NAME.organ -> NAME.quadratic.organ, as bake and import name it.
std::filesystem::path quadratic_file(std::filesystem::path organ) {
    return organ.replace_extension(".quadratic.organ");
}

// Null if the file is no good and mistakes are kept.
std::shared_ptr<const tissue::BakedOrgan> load_organ(const std::filesystem::path& path,
                                                     const TomlTable& t, Mistakes* mistakes,
                                                     std::string& digest) {
    try {
        const std::vector<std::byte> bytes = read_bytes(path);
        digest += sha256_hex(bytes);
        return std::make_shared<const tissue::BakedOrgan>(tissue::read_organ(bytes));
    } catch (const std::invalid_argument& e) { // damaged
        refuse_or_keep(
            t, "file",
            fmt::format("an organ made by bake or trocar import; {}: {}", path.string(), e.what()),
            mistakes);
    } catch (const std::runtime_error& e) { // not there, or not readable
        refuse_or_keep(t, "file",
                       fmt::format("an organ file in the scene's directory; {}", e.what()),
                       mistakes);
    }
    return nullptr;
}

void load_regions(SceneOrgan& organ, const ScenePlace& place, const TomlTable& t,
                  Mistakes* mistakes, std::string& digest) {
    if (organ.anchor.empty())
        return;
    const std::vector<TomlTable> tables = t.tables("anchor");
    for (std::size_t a = 0; a < organ.anchor.size() && a < tables.size(); ++a) {
        auto* region = std::get_if<AnchorRegion>(&organ.anchor[a]);
        if (!region)
            continue;
        const std::filesystem::path path = place.folder / region->file;
        try {
            const std::vector<std::byte> bytes = read_bytes(path, kMaxRegionBytes);
            digest += sha256_hex(bytes);
            region->ball = parse_region({reinterpret_cast<const char*>(bytes.data()), bytes.size()},
                                        path.string());
        } catch (const tasks::BadInput& mistake) {
            if (!mistakes)
                throw;
            mistakes->push_back(mistake);
        } catch (const std::runtime_error& e) {
            refuse_or_keep(
                tables[a], "region",
                fmt::format("a file of balls x y z r in the scene's directory; {}", e.what()),
                mistakes);
        }
    }
}

std::function<bool(const glm::dvec3&)> inside_of(std::vector<DistanceField> fields) {
    return [fields = std::move(fields)](const glm::dvec3& p_m) {
        return std::any_of(fields.begin(), fields.end(),
                           [&](const DistanceField& field) { return field(p_m) <= 0.0; });
    };
}

} // namespace

std::shared_ptr<const tissue::BoundaryTree> rest_surface(const tissue::BakedOrgan& organ) {
    return std::make_shared<const tissue::BoundaryTree>(
        tissue::make_surface_tree(organ.surface.rest_m, organ.surface.triangles));
}

std::vector<DistanceField> anchor_fields(const LoadedScene& loaded, std::size_t index) {
    std::vector<DistanceField> fields;
    for (const Anchor& anchor : loaded.scene.organ[index].anchor) {
        std::shared_ptr<const tissue::BoundaryTree> surface;
        if (const auto* touching = std::get_if<AnchorTouching>(&anchor)) {
            for (std::size_t o = 0; o < loaded.organ.size(); ++o) {
                if (loaded.scene.organ[o].name == touching->organ)
                    surface = rest_surface(*loaded.organ[o]);
            }
        }
        fields.push_back(anchor_distance(anchor, std::move(surface)));
    }
    return fields;
}

LoadedScene load_organs(Scene scene, ScenePlace place, Mistakes* mistakes) {
    LoadedScene loaded{std::move(scene), std::move(place), {}, {}, {}};
    const std::vector<TomlTable> tables =
        TomlTable::parse(loaded.scene.text, loaded.place.file.string()).tables("organ");
    std::string digest(loaded.scene.text), regions;
    for (std::size_t i = 0; i < loaded.scene.organ.size(); ++i) {
        SceneOrgan& organ = loaded.scene.organ[i];
        loaded.organ.emplace_back();
        loaded.quadratic.emplace_back();
        if (organ.file.empty())
            continue; // said already
        loaded.organ.back() =
            load_organ(organ_file(loaded.place, organ.file), tables[i], mistakes, digest);
        const std::filesystem::path coarse = quadratic_file(organ_file(loaded.place, organ.file));
        if (loaded.organ.back() && !loaded.organ.back()->rigid && std::filesystem::exists(coarse))
            loaded.quadratic.back() = load_organ(coarse, tables[i], mistakes, digest);
        if (loaded.organ.back() && loaded.organ.back()->rigid && !organ.anchor.empty())
            refuse_or_keep(tables[i], "anchor", "no anchor: this organ is rigid", mistakes);
        load_regions(organ, loaded.place, tables[i], mistakes, regions);
    }
    digest += regions;
    loaded.hash = sha256_hex(std::as_bytes(std::span(digest)));
    if (mistakes && !mistakes->empty())
        return loaded;
    for (std::size_t i = 0; i < loaded.organ.size(); ++i) {
        const SceneOrgan& organ = loaded.scene.organ[i];
        if (organ.anchor.empty() || loaded.organ[i]->rigid)
            continue;
        try {
            if (tissue::is_rod(*loaded.organ[i])) {
                loaded.organ[i] = std::make_shared<const tissue::BakedOrgan>(rod_held_by(
                    *loaded.organ[i], inside_of(anchor_fields(loaded, i)), organ.hold_length_m));
                continue;
            }
            for (auto* baked : {&loaded.organ[i], &loaded.quadratic[i]}) {
                if (*baked)
                    *baked = std::make_shared<const tissue::BakedOrgan>(
                        held_by(**baked, bed_of((*baked)->mesh, anchor_fields(loaded, i),
                                                organ.hold_length_m)));
            }
        } catch (const std::invalid_argument& e) {
            refuse_or_keep(tables[i], "file",
                           fmt::format("an organ whose hold can be changed; {}", e.what()),
                           mistakes);
        }
    }
    return loaded;
}

LoadedScene load_scene(const std::string& scene) {
    const ScenePlace place = find_scene(scene);
    return load_organs(parse_scene(read_text(place.file), place.file.string()), place);
}

} // namespace sim
