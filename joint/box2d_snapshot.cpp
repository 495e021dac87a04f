// What b2World keeps, as bytes. Bodies, fixtures, joints and contacts lie in the chunks of its block
// allocator and know each other by address, so bytes that are put back where they were are the same world
// again: order of lists, warm starts, sleep timers and the broad phase's tree included. Written against
// Box2D 2.4.1.

#include <algorithm>
#include <cstring>
#include <iterator>
#include <memory>
#include <stdexcept>
#include <utility>
#include <vector>

#include "blocks.h"
#include "box2d_private.h"
#include "reveal.h"
#include "structure.h"

namespace ductile::dynamics {

using FreeLists = b2Block* [b2_blockSizeCount];
DUCTILE_REVEAL(b2World, m_blockAllocator, b2BlockAllocator);
DUCTILE_REVEAL(b2World, m_profile, b2Profile);
DUCTILE_REVEAL(b2BlockAllocator, m_chunks, b2Chunk*);
DUCTILE_REVEAL(b2BlockAllocator, m_chunkCount, int32);
DUCTILE_REVEAL(b2BlockAllocator, m_freeLists, FreeLists);
DUCTILE_REVEAL(b2BroadPhase, m_proxyCount, int32);

}  // namespace ductile::dynamics

namespace ductile {

using namespace dynamics;

namespace {

// b2_block_allocator.cpp
struct Chunk {
  int32 block_size;
  std::byte* blocks;
};
struct FreeBlock {
  FreeBlock* next;
};
static_assert(std::size(block_sizes) == b2_blockSizeCount);
static_assert(block_of(sizeof(b2Body)) > 0 && block_of(sizeof(b2WheelJoint)) > 0,
              "what is larger lies elsewhere");

using Bytes = std::vector<std::byte>;

void append(Bytes& bytes, const void* from, std::size_t size) {
  const auto* begin = static_cast<const std::byte*>(from);
  bytes.insert(bytes.end(), begin, begin + size);
}

/// A chain's points, and its proxies where they are many, lie outside the allocator.
struct Chain {
  b2Fixture* fixture;
  const b2Vec2* at;
  std::vector<b2Vec2> points;
  std::vector<b2FixtureProxy> proxies;

  bool operator==(const Chain& o) const {
    return fixture == o.fixture && at == o.at && points.size() == o.points.size() &&
           std::equal(points.begin(), points.end(), o.points.begin());
  }
};

std::vector<Chain> chains_in(b2World& world) {
  std::vector<Chain> chains;
  for (b2Body* b = world.GetBodyList(); b != nullptr; b = b->GetNext()) {
    for (b2Fixture* f = b->GetFixtureList(); f != nullptr; f = f->GetNext()) {
      if (f->GetType() != b2Shape::e_chain) continue;
      const auto* chain = static_cast<const b2ChainShape*>(f->GetShape());
      const b2FixtureProxy* proxies = of(*f, b2Fixture_m_proxies{});
      chains.push_back({f,
                        chain->m_vertices,
                        {chain->m_vertices, chain->m_vertices + chain->m_count},
                        {proxies, proxies + chain->GetChildCount()}});
    }
  }
  return chains;
}

/// The broad phase's tree of boxes.
struct Tree {
  int32 root = 0, node_count = 0, free_node = 0, insertion_count = 0;
  std::vector<b2TreeNode> nodes;

  void save(b2DynamicTree& of_world);
  void restore(b2DynamicTree& of_world) const;
};

void Tree::save(b2DynamicTree& tree) {
  root = of(tree, b2DynamicTree_m_root{});
  node_count = of(tree, b2DynamicTree_m_nodeCount{});
  free_node = of(tree, b2DynamicTree_m_freeList{});
  insertion_count = of(tree, b2DynamicTree_m_insertionCount{});
  const b2TreeNode* node = of(tree, b2DynamicTree_m_nodes{});
  nodes.assign(node, node + of(tree, b2DynamicTree_m_nodeCapacity{}));
}

void Tree::restore(b2DynamicTree& tree) const {
  of(tree, b2DynamicTree_m_root{}) = root;
  of(tree, b2DynamicTree_m_nodeCount{}) = node_count;
  of(tree, b2DynamicTree_m_freeList{}) = free_node;
  of(tree, b2DynamicTree_m_insertionCount{}) = insertion_count;
  b2TreeNode*& node = of(tree, b2DynamicTree_m_nodes{});
  // Proxies are numbered by nodes, and pairs ordered by those numbers: the capacity decides which number is
  // next.
  const auto capacity = static_cast<int32>(nodes.size());
  if (std::exchange(of(tree, b2DynamicTree_m_nodeCapacity{}), capacity) != capacity) {
    b2Free(node);
    node = static_cast<b2TreeNode*>(b2Alloc(capacity * static_cast<int32>(sizeof(b2TreeNode))));
  }
  std::copy(nodes.begin(), nodes.end(), node);
}

b2ContactManager& contacts_of(b2World& world) {
  return const_cast<b2ContactManager&>(world.GetContactManager());  // of a world that is not const
}

}  // namespace

struct Snapshot::Impl {
  b2World* world = nullptr;
  // b2World's own members: lists, settings, and what goes from step to step. Not its listeners.
  Bytes lists, settings;
  b2Contact* contact_list = nullptr;
  int32 contact_count = 0;
  // b2BlockAllocator
  Bytes chunks;
  std::vector<const void*> places;  // of the chunks, which stay where they are as long as the world lives
  FreeLists free_lists;
  int32 proxy_count = 0;  // of b2BroadPhase
  std::vector<int32> moved;
  Tree tree;
  std::vector<Chain> chains;
  std::vector<std::pair<Structure::Impl*, Structure::Impl::State>> structures;
  std::vector<std::pair<std::shared_ptr<Island>, Island::State>> islands;  // that they share

  void save(b2World& w);
  void restore(b2World& w) const;
};

namespace {

/// From one member of the world up to another.
std::pair<std::byte*, std::size_t> between(void* first, void* end) {
  auto* begin = static_cast<std::byte*>(first);
  return {begin, static_cast<std::size_t>(static_cast<std::byte*>(end) - begin)};
}
auto lists_of(b2World& world) {
  return between(&of(world, b2World_m_bodyList{}), &of(world, b2World_m_destructionListener{}));
}
auto settings_of(b2World& world) {
  return between(&of(world, b2World_m_inv_dt0{}), &of(world, b2World_m_profile{}));
}

}  // namespace

void Snapshot::Impl::save(b2World& w) {
  if (w.IsLocked()) throw std::logic_error("snapshot: the world is stepping; save it between steps");
  world = &w;
  const auto keep = [](Bytes& bytes, const std::pair<std::byte*, std::size_t>& range) {
    bytes.assign(range.first, range.first + range.second);
  };
  keep(lists, lists_of(w));
  keep(settings, settings_of(w));

  b2BlockAllocator& allocator = of(w, b2World_m_blockAllocator{});
  const auto* chunk = reinterpret_cast<const Chunk*>(of(allocator, b2BlockAllocator_m_chunks{}));
  chunks.clear();
  places.clear();
  for (int32 i = 0; i < of(allocator, b2BlockAllocator_m_chunkCount{}); ++i) {
    append(chunks, chunk[i].blocks, chunk_size);
    places.push_back(chunk[i].blocks);
  }
  std::copy_n(of(allocator, b2BlockAllocator_m_freeLists{}), b2_blockSizeCount, free_lists);

  b2ContactManager& contacts = contacts_of(w);
  contact_list = contacts.m_contactList;
  contact_count = contacts.m_contactCount;
  b2BroadPhase& phase = contacts.m_broadPhase;
  proxy_count = of(phase, b2BroadPhase_m_proxyCount{});
  const int32* buffer = of(phase, b2BroadPhase_m_moveBuffer{});
  moved.assign(buffer, buffer + of(phase, b2BroadPhase_m_moveCount{}));
  tree.save(of(phase, b2BroadPhase_m_tree{}));

  chains = chains_in(w);
  structures.clear();
  islands.clear();
  for (Structure::Impl* s : structures_in(w)) {
    structures.emplace_back(s, s->state());
    const auto is_saved = [s](const auto& saved) { return saved.first == s->island; };
    if (std::none_of(islands.begin(), islands.end(), is_saved))
      islands.emplace_back(s->island, s->island->state());
  }
}

void Snapshot::Impl::restore(b2World& w) const {
  // A new world may be where the old one was, and its structure, too.
  b2BlockAllocator& allocator = of(w, b2World_m_blockAllocator{});
  auto* chunk = reinterpret_cast<Chunk*>(of(allocator, b2BlockAllocator_m_chunks{}));
  const auto known = static_cast<int32>(places.size());
  if (&w != world || of(allocator, b2BlockAllocator_m_chunkCount{}) < known ||
      !std::equal(places.begin(), places.end(), chunk,
                  [](const void* place, const Chunk& now) { return place == now.blocks; }))
    throw std::logic_error("snapshot: of another world; restore it into the one it was saved of");
  if (w.IsLocked()) throw std::logic_error("snapshot: the world is stepping; restore it between steps");
  if (chains_in(w) != chains) {
    throw std::logic_error(
        "snapshot: a chain shape has come or gone since; make chains before the first save");
  }
  const auto same = [](const Structure::Impl* now, const auto& saved) {
    return now == saved.first && now->island == saved.second.island;
  };
  if (const auto now = structures_in(w);
      !std::equal(now.begin(), now.end(), structures.begin(), structures.end(), same)) {
    throw std::logic_error(
        "snapshot: a structure has come or gone since; make structures before the first save");
  }

  std::copy(lists.begin(), lists.end(), lists_of(w).first);
  std::copy(settings.begin(), settings.end(), settings_of(w).first);

  FreeLists& free = of(allocator, b2BlockAllocator_m_freeLists{});
  std::copy_n(free_lists, b2_blockSizeCount, free);
  for (int32 i = 0; i < known; ++i) {
    std::memcpy(chunk[i].blocks, chunks.data() + static_cast<std::size_t>(i) * chunk_size, chunk_size);
  }
  // Chunks that came since are free, all of them; they stay, for a later snapshot may need them in their
  // place.
  for (int32 i = known; i < of(allocator, b2BlockAllocator_m_chunkCount{}); ++i) {
    const auto size = static_cast<std::size_t>(chunk[i].block_size);
    auto& head = free[std::find(block_sizes, block_sizes + b2_blockSizeCount, size) - block_sizes];
    for (std::size_t at = 0; at + size <= chunk_size; at += size) {
      head = reinterpret_cast<b2Block*>(new (chunk[i].blocks + at)
                                            FreeBlock{reinterpret_cast<FreeBlock*>(head)});
    }
  }

  b2ContactManager& contacts = contacts_of(w);
  contacts.m_contactList = contact_list;
  contacts.m_contactCount = contact_count;
  b2BroadPhase& phase = contacts.m_broadPhase;
  of(phase, b2BroadPhase_m_proxyCount{}) = proxy_count;
  std::copy(moved.begin(), moved.end(), of(phase, b2BroadPhase_m_moveBuffer{}));  // which never shrinks
  of(phase, b2BroadPhase_m_moveCount{}) = static_cast<int32>(moved.size());
  tree.restore(of(phase, b2BroadPhase_m_tree{}));

  for (const Chain& chain : chains) {
    std::copy(chain.proxies.begin(), chain.proxies.end(), of(*chain.fixture, b2Fixture_m_proxies{}));
  }
  for (const auto& [structure, state] : structures) structure->restore(state);
  for (const auto& [island, state] : islands) island->restore(state);
}

Snapshot::Snapshot() : impl_(std::make_unique<Impl>()) {}
Snapshot::~Snapshot() = default;
Snapshot::Snapshot(Snapshot&&) noexcept = default;
Snapshot& Snapshot::operator=(Snapshot&&) noexcept = default;
void Snapshot::save(b2World& world) { impl_->save(world); }
void Snapshot::restore(b2World& world) const { impl_->restore(world); }

}  // namespace ductile
