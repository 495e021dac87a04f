// The broad phase's tree in a document (world_archive.h). Written against Box2D 2.4.1.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "box2d_private.h"
#include "vec3.h"
#include "world_archive.h"

namespace ductile {

using namespace dynamics;

namespace {

// Whether the nodes are a tree whose leaves are these, and a list of free ones.
bool sound(const std::vector<b2TreeNode>& nodes, int32 root, int32 node_count, int32 free,
           std::size_t leaves) {
  const auto inside = [&](int32 i) { return i >= 0 && z(i) < nodes.size(); };
  std::vector<bool> seen(nodes.size());
  std::size_t seen_count = 0, seen_leaves = 0;
  const auto see = [&](int32 i) {
    if (!inside(i) || seen[z(i)]) return false;
    ++seen_count;
    seen[z(i)] = true;
    return true;
  };
  std::vector<int32> to_visit;
  if (root != b2_nullNode) {
    if (!see(root) || nodes[z(root)].parent != b2_nullNode) return false;
    to_visit.push_back(root);
  }
  while (!to_visit.empty()) {
    const int32 i = to_visit.back();
    to_visit.pop_back();
    const b2TreeNode& node = nodes[z(i)];
    if (node.IsLeaf()) {
      ++seen_leaves;
      if (node.userData == nullptr || node.height != 0) return false;
      continue;
    }
    for (const int32 child : {node.child1, node.child2}) {
      if (!see(child) || nodes[z(child)].parent != i) return false;
      to_visit.push_back(child);
    }
    if (node.userData != nullptr ||
        node.height != 1 + std::max(nodes[z(node.child1)].height, nodes[z(node.child2)].height))
      return false;
  }
  if (seen_count != z(node_count) || seen_leaves != leaves) return false;
  for (int32 i = free; i != b2_nullNode; i = nodes[z(i)].next) {
    if (!see(i) || nodes[z(i)].height != -1) return false;
  }
  return seen_count == nodes.size();
}

}  // namespace

void WorldArchive::broad_phase(Archive& a) {
  b2BroadPhase& phase = const_cast<b2ContactManager&>(world_.GetContactManager()).m_broadPhase;
  b2DynamicTree& tree = of(phase, b2BroadPhase_m_tree{});
  b2TreeNode*& there = of(tree, b2DynamicTree_m_nodes{});
  a.object("broad_phase", [&](Archive& each) {
    std::vector<float> boxes;
    std::vector<std::int32_t> links, moved;
    int32 root = of(tree, b2DynamicTree_m_root{}), free = of(tree, b2DynamicTree_m_freeList{});
    int32 node_count = of(tree, b2DynamicTree_m_nodeCount{});
    for (int32 i = 0; i < of(tree, b2DynamicTree_m_nodeCapacity{}) && !each.reads(); ++i) {
      const b2TreeNode& n = there[i];
      const bool used = n.height >= 0;
      const b2AABB box = used ? n.aabb : b2AABB{{0, 0}, {0, 0}};
      boxes.insert(boxes.end(), {box.lowerBound.x, box.lowerBound.y, box.upperBound.x, box.upperBound.y});
      links.insert(links.end(),
                   {n.parent, used ? n.child1 : -1, used ? n.child2 : -1, n.height, used && n.moved ? 1 : 0});
    }
    if (!each.reads()) {
      const int32* buffer = of(phase, b2BroadPhase_m_moveBuffer{});
      moved.assign(buffer, buffer + of(phase, b2BroadPhase_m_moveCount{}));
    }
    each("root", root);
    each("free", free);
    each("nodes", node_count);
    each("boxes", boxes);
    each("links", links);
    each("moved", moved);
    each("insertions", of(tree, b2DynamicTree_m_insertionCount{}));
    if (!each.reads()) return;
    std::vector<b2TreeNode> nodes(boxes.size() / 4);
    if (boxes.size() != 4 * nodes.size() || links.size() != 5 * nodes.size() || nodes.empty())
      each.refuse("links", "must be five for each four of `boxes`");
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      b2TreeNode& n = nodes[i];
      const float* box = &boxes[4 * i];
      const std::int32_t* link = &links[5 * i];
      n.aabb = {{box[0], box[1]}, {box[2], box[3]}};
      n.userData = nullptr;
      n.parent = link[0], n.child1 = link[1], n.child2 = link[2], n.height = link[3], n.moved = link[4] != 0;
    }
    for (const Proxy& p : proxies_) {
      if (p.id < 0 || z(p.id) >= nodes.size() || nodes[z(p.id)].userData != nullptr)
        each.refuse("boxes", "have no place for proxy " + std::to_string(p.id));
      nodes[z(p.id)].userData = p.at;
    }
    if (!sound(nodes, root, node_count, free, proxies_.size()))
      each.refuse("links", "are no tree of these proxies");
    for (const std::int32_t id : moved) {
      if (id != b2BroadPhase::e_nullProxy &&
          (id < 0 || z(id) >= nodes.size() || nodes[z(id)].userData == nullptr))
        each.refuse("moved", "names what is no proxy");
    }
    for (const Proxy& p : proxies_) p.at->aabb = p.box, p.at->proxyId = p.id;
    of(tree, b2DynamicTree_m_root{}) = root;
    of(tree, b2DynamicTree_m_freeList{}) = free;
    of(tree, b2DynamicTree_m_nodeCount{}) = node_count;
    const auto capacity = static_cast<int32>(nodes.size());
    if (std::exchange(of(tree, b2DynamicTree_m_nodeCapacity{}), capacity) != capacity) {
      b2Free(there);
      there = static_cast<b2TreeNode*>(b2Alloc(capacity * static_cast<int32>(sizeof(b2TreeNode))));
    }
    std::copy(nodes.begin(), nodes.end(), there);
    of(phase, b2BroadPhase_m_moveCount{}) = 0;
    for (const std::int32_t id : moved) {
      if (id != b2BroadPhase::e_nullProxy) phase.TouchProxy(id);
    }
  });
}

}  // namespace ductile
