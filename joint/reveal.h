// Box2D's private members, read where its interface has no word for them: explicit instantiation may name
// them ([temp.spec.general]/6). Layout as in Box2D 2.4.1.
//
//   DUCTILE_REVEAL(b2Body, m_islandIndex, int32);
//   of(body, b2Body_m_islandIndex{})
#pragma once

namespace ductile::dynamics {

template <class Tag, typename Tag::Type member>
struct Reveal {
  friend typename Tag::Type reveal(Tag) { return member; }
};

#define DUCTILE_REVEAL(Class, member, ...) \
  struct Class##_##member {                \
    using Type = __VA_ARGS__ Class::*;     \
    friend Type reveal(Class##_##member);  \
  };                                       \
  template struct Reveal<Class##_##member, &Class::member>

template <class Tag, class Object>
auto& of(Object& object, Tag tag) {
  return object.*reveal(tag);
}

}  // namespace ductile::dynamics
