// tests/bench/bullet_peer.cpp
// Bullet on the contact workload: a program that prints one JSON object with two rows, neither of
// them a closest point, which Bullet does not offer: "contact": the ball at the device's place
// against the mesh (contactPairTest), which finds nothing once the centre is deeper than the
// radius; "sweep": the ball comes down to the device from 10 mm outside, along the organ's radius
// or the sheet's vertical (objectQuerySingle). Refit by refitTree. In millimetres, which suits
// Bullet's absolute tolerances better than metres.
#include "tests/bench/peer.h"

#include <btBulletCollisionCommon.h>
#include <glm/geometric.hpp>
#include <memory>

namespace {

using glm::dvec3;

constexpr double kMm = 1e3;         // of a metre
constexpr float kMargin_mm = 1e-3f; // Bullet's default would be 40
constexpr double kRoom_m = 0.015;   // that the mesh may move in: boxes are quantised once
constexpr double kFrom_m = 0.010;   // where a sweep begins, off the device

btVector3 in_mm(const dvec3& p) {
    return {static_cast<btScalar>(kMm * p.x), static_cast<btScalar>(kMm * p.y),
            static_cast<btScalar>(kMm * p.z)};
}

btTransform at(const dvec3& p) {
    return btTransform(btQuaternion::getIdentity(), in_mm(p));
}

struct Nearest : btCollisionWorld::ContactResultCallback {
    bool hit = false;
    btScalar distance_mm = 0;

    btScalar addSingleResult(btManifoldPoint& point, const btCollisionObjectWrapper*, int, int,
                             const btCollisionObjectWrapper*, int, int) override {
        if (!hit || point.getDistance() < distance_mm)
            distance_mm = point.getDistance();
        hit = true;
        return 0;
    }
};

class World {
  public:
    World(const haptics::MeshView& mesh, double radius_m)
        : ball_(static_cast<btScalar>(kMm * radius_m)), radius_m_(radius_m) {
        for (const haptics::Corners& t : mesh.triangle)
            for (const std::uint32_t v : t)
                corner_.push_back(static_cast<int>(v));
        place_mm_.resize(mesh.vertex_m.size());
        take(mesh);
        faces_ = std::make_unique<btTriangleIndexVertexArray>(
            static_cast<int>(mesh.triangle.size()), corner_.data(), int{3 * sizeof(int)},
            static_cast<int>(place_mm_.size()), place_mm_.data()->m_floats, int{sizeof(btVector3)});
        const btVector3 room = in_mm(dvec3{kRoom_m});
        shape_ = std::make_unique<btBvhTriangleMeshShape>(faces_.get(), true, low_mm_ - room,
                                                          high_mm_ + room);
        shape_->setMargin(kMargin_mm);
        skin_.setCollisionShape(shape_.get());
        tip_.setCollisionShape(&ball_);
    }

    void take(const haptics::MeshView& mesh) {
        low_mm_ = high_mm_ = in_mm(mesh.vertex_m[0]);
        for (std::size_t v = 0; v < place_mm_.size(); ++v) {
            place_mm_[v] = in_mm(mesh.vertex_m[v]);
            low_mm_.setMin(place_mm_[v]);
            high_mm_.setMax(place_mm_[v]);
        }
    }
    void refit() { shape_->refitTree(low_mm_, high_mm_); }

    bench::PeerAnswer contact(const dvec3& place) {
        tip_.setWorldTransform(at(place));
        Nearest nearest;
        world_.contactPairTest(&tip_, &skin_, nearest);
        return {nearest.hit, radius_m_ + nearest.distance_mm / kMm};
    }
    bench::PeerAnswer sweep(const dvec3& from, const dvec3& to) {
        btCollisionWorld::ClosestConvexResultCallback first(in_mm(from), in_mm(to));
        btCollisionWorld::objectQuerySingle(&ball_, at(from), at(to), &skin_, shape_.get(),
                                            skin_.getWorldTransform(), first, 0);
        return {first.hasHit(), 0.0}; // touched on the way: pressed
    }

  private:
    std::vector<int> corner_;
    std::vector<btVector3> place_mm_; // four floats each
    btVector3 low_mm_, high_mm_;
    std::unique_ptr<btTriangleIndexVertexArray> faces_;
    std::unique_ptr<btBvhTriangleMeshShape> shape_;
    btSphereShape ball_;
    double radius_m_;
    btDefaultCollisionConfiguration configuration_;
    btCollisionDispatcher dispatcher_{&configuration_};
    btDbvtBroadphase broadphase_;
    btCollisionWorld world_{&dispatcher_, &broadphase_, &configuration_};
    btCollisionObject skin_, tip_;
};

bench::Peer make_bullet(const haptics::MeshView& mesh, const sim::ContactWorkload& work,
                        double radius_m, bool sweep) {
    const auto world = std::make_shared<World>(mesh, radius_m);
    bench::Peer peer{.name = sweep ? "bullet-sweep" : "bullet-contact",
                     .closest = false,
                     .take = [world](const haptics::MeshView& moved) { world->take(moved); },
                     .refit = [world] { world->refit(); },
                     .ask = {}};
    if (sweep)
        peer.ask = [world, organ = work.organ.has_value()](const dvec3& place) {
            const dvec3 out = organ ? glm::normalize(place) : dvec3{0.0, 0.0, 1.0};
            return world->sweep(place + kFrom_m * out, place);
        };
    else
        peer.ask = [world](const dvec3& place) { return world->contact(place); };
    return peer;
}

} // namespace

int main(int argc, char** argv) {
    return bench::peer_main(argc, argv, [](const bench::PeerOptions& o, const auto& work) {
        nlohmann::ordered_json both;
        for (const bool sweep : {false, true})
            both[sweep ? "sweep" : "contact"] =
                bench::run_peer(o, work, [&](const haptics::MeshView& mesh) {
                    return make_bullet(mesh, work, o.radius_m, sweep);
                });
        return both;
    });
}
