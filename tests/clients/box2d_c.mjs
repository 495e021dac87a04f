// What the engines with Box2D 3's functions have in common; B are those of one of them.
const substeps = 8;

export const jointKinds = {weld: 'Weld', revolute: 'Revolute', prismatic: 'Prismatic', wheel: 'Wheel'};

export function createBody(B, world, b, type) {
  const vec = ([x, y]) => new B.b2Vec2(x, y);
  const def = B.b2DefaultBodyDef();
  def.type = type;
  def.position = vec(b.position);
  def.linearVelocity = vec(b.linearVelocity);
  def.angularVelocity = b.angularVelocity;
  def.enableSleep = b.allowSleep;
  return B.b2CreateBody(world, def);
}

export function setMass(B, body, b) {
  const mass = new B.b2MassData();
  mass.mass = b.mass;
  mass.center = new B.b2Vec2(0, 0);
  mass.rotationalInertia = b.inertia;
  B.b2Body_SetMassData(body, mass);
}

/// What a test may ask of a world.
export function player(B, world, bodies) {
  return {
    gravity: ([x, y]) => B.b2World_SetGravity(world, new B.b2Vec2(x, y)),
    step: () => B.b2World_Step(world, 1 / 60, substeps),
    angle: (name) => B.b2Rot_GetAngle(B.b2Body_GetRotation(bodies[name])),
    position: (name) => { const {x, y} = B.b2Body_GetPosition(bodies[name]); return [x, y]; },
    mass: (name) => B.b2Body_GetMass(bodies[name]),
  };
}
