// Box2D 3.0 in JavaScript (phaser-box2d): what `--to box2d` says under "3", whose frames are anchors, an axis and a
// reference angle here.
import * as B from './node_modules/phaser-box2d/dist/PhaserBox2D.js';

const vec = ([x, y]) => new B.b2Vec2(x, y);
const kinds = {weld: 'Weld', revolute: 'Revolute', prismatic: 'Prismatic', wheel: 'Wheel'};
const substeps = 8;

export function load(doc, choose) {
  B.b2CreateWorldArray();
  const worldDef = B.b2DefaultWorldDef();
  worldDef.gravity = vec(doc.gravity);
  const world = B.b2CreateWorld(worldDef);
  const bodies = {};
  for (const b of doc.bodies) {
    const def = B.b2DefaultBodyDef();
    def.type = ['static', 'kinematic', 'dynamic'].indexOf(b.type);
    def.position = vec(b.position);
    def.linearVelocity = vec(b.linearVelocity);
    def.angularVelocity = b.angularVelocity;
    def.enableSleep = b.allowSleep;
    const body = bodies[b.name] = B.b2CreateBody(world, def);
    for (const f of b.fixtures) {
      const shape = B.b2DefaultShapeDef();
      shape.density = f.density;
      shape.friction = f.friction;
      shape.restitution = f.restitution;
      shape.filter.groupIndex = f.groupIndex;
      if (f.polygon)
        B.b2CreatePolygonShape(body, shape, B.b2MakePolygon(B.b2ComputeHull(f.polygon.map(vec), f.polygon.length), 0));
      else
        B.b2CreateCircleShape(body, shape, new B.b2Circle(vec(f.center), f.circle));
    }
    if (b.type === 'dynamic') {
      const mass = new B.b2MassData();
      mass.mass = b.mass;
      mass.center = vec([0, 0]);
      mass.rotationalInertia = b.inertia;
      B.b2Body_SetMassData(body, mass);
    }
  }
  for (const joint of doc.joints) {
    const {type, localFrameA, localFrameB, ...fields} = choose(joint)['3'];
    const def = B[`b2Default${kinds[type]}JointDef`]();
    def.bodyIdA = bodies[joint.bodyA];
    def.bodyIdB = bodies[joint.bodyB];
    def.localAnchorA = vec(localFrameA.p);
    def.localAnchorB = vec(localFrameB.p);
    if ('localAxisA' in def) def.localAxisA = vec([Math.cos(localFrameA.angle), Math.sin(localFrameA.angle)]);
    if ('referenceAngle' in def) def.referenceAngle = localFrameA.angle - localFrameB.angle;
    for (const [key, value] of Object.entries(fields)) {
      if (!(key in def)) throw new Error(`${type} has no ${key}`);
      def[key] = value;
    }
    B[`b2Create${kinds[type]}Joint`](world, def);
  }
  return {
    gravity: (g) => B.b2World_SetGravity(world, vec(g)),
    step: () => B.b2World_Step(world, 1 / 60, substeps),
    angle: (name) => B.b2Rot_GetAngle(B.b2Body_GetRotation(bodies[name])),
    position: (name) => { const {x, y} = B.b2Body_GetPosition(bodies[name]); return [x, y]; },
    mass: (name) => B.b2Body_GetMass(bodies[name]),
  };
}
