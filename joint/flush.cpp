// Pieces that are flush with a wall: Box2D's continuous collision would put any two bodies apart in each step
// that are nearer than its slop, a piece alone and by a centimetre, and wake both. The piece would jump there
// and back, as its structure does not give, and never fall asleep. So a contact with what does not move is
// disabled while b2World goes on to continuous collision, where the piece stands: its points are rows of the
// structure's problem, which let nothing close. Written against Box2D 2.4.1.
#include <utility>

#include "box2d_private.h"
#include "island.h"
#include "structure.h"

namespace ductile::dynamics {

namespace {

// A bit of it that is ours. Box2D 2.4.1 uses the six lowest, and leaves the others as they are.
constexpr uint32 held_apart = 0x8000;

// Whether continuous collision finds that the two touch before they move: that is where shapes without their
// skins are as near as the slop and a quarter of it, which a hair is added to.
bool is_flush(const b2Contact& contact) { return separation_of(contact) < -2.5f * b2_linearSlop; }

}  // namespace

void Island::hold_apart(float h) {
  if (!direct() || !world().GetContinuousPhysics() || world().GetSubStepping()) return;
  for (const Component* c : active_) {
    c->each_standing_touch(h, [this](b2Contact& contact) {
      if (!is_flush(contact)) return;
      contact.SetEnabled(false);
      of(contact, b2Contact_m_flags{}) |= held_apart;
      holds_contacts_ = true;
    });
  }
}

void Island::let_contacts_go(b2World& in) {
  if (!std::exchange(holds_contacts_, false)) return;
  for (b2Contact* c = in.GetContactList(); c != nullptr; c = c->GetNext()) {
    uint32& flags = of(*c, b2Contact_m_flags{});
    if ((flags & held_apart) == 0) continue;
    flags &= ~held_apart;
    c->SetEnabled(true);
  }
}

}  // namespace ductile::dynamics
