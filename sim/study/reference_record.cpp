// Presses as text: a line of figures for each place, then a line for each depth.
#include "sim/study/reference_record.h"

#include "sim/io/files.h"

#include <fmt/format.h>
#include <sstream>
#include <stdexcept>

namespace sim {
namespace {

// place,reached,penetration,det F,nodes,tets,solves,CPU,depths,why it stopped
void read_place(std::istream& in, std::vector<ReferencePress>& presses) {
    ReferencePress p;
    std::size_t depths = 0;
    in >> p.reached_m >> p.penetration_m >> p.least_det_f >> p.nodes >> p.tets >> p.iterations >>
        p.cpu_s >> depths;
    in.get();
    std::getline(in, p.stopped);
    for (std::size_t d = 0; d < depths && in; ++d) {
        glm::dvec3 f{0.0};
        in >> f.x >> f.y >> f.z;
        p.force_n.push_back(f);
    }
    if (in)
        presses.push_back(std::move(p));
}

} // namespace

std::vector<ReferencePress> read_presses(const std::filesystem::path& file,
                                         const std::string& key) {
    std::vector<ReferencePress> presses;
    if (file.empty() || !std::filesystem::exists(file))
        return presses;
    std::istringstream in(read_text(file));
    std::string line;
    std::getline(in, line);
    if (line != key)
        return presses;
    while (in >> std::ws && !in.eof()) {
        const std::size_t before = presses.size();
        read_place(in, presses);
        if (presses.size() == before) {
            throw std::runtime_error(fmt::format("{}: press {} cannot be read: delete the file to "
                                                 "press again",
                                                 file.string(), before + 1));
        }
    }
    return presses;
}

void write_presses(const std::filesystem::path& file, const std::string& key,
                   const std::vector<ReferencePress>& presses) {
    std::string text = key + "\n";
    for (const ReferencePress& p : presses) {
        text += fmt::format("{:.17g} {:.9g} {:.9g} {} {} {} {:.1f} {} {}\n", p.reached_m,
                            p.penetration_m, p.least_det_f, p.nodes, p.tets, p.iterations, p.cpu_s,
                            p.force_n.size(), p.stopped);
        for (const glm::dvec3& f : p.force_n)
            text += fmt::format("{:.17g} {:.17g} {:.17g}\n", f.x, f.y, f.z);
    }
    write_text(file, text);
}

} // namespace sim
