// Box2D 3.0 in JavaScript (phaser-box2d): what `--to box2d` says under "3", whose frames are anchors, an axis and a
// reference angle here.
import * as B from './node_modules/phaser-box2d/dist/PhaserBox2D.js';
import {createBody, jointKinds, player, setMass} from './box2d_c.mjs';
import {setFields} from './fields.mjs';

const vec = ([x, y]) => new B.b2Vec2(x, y);

export function load(doc, choose) {
  B.b2CreateWorldArray();
  const worldDef = B.b2DefaultWorldDef();
  worldDef.gravity = vec(doc.gravity);
  const world = B.b2CreateWorld(worldDef);
  const bodies = {};
  for (const b of doc.bodies) {
    const body = bodies[b.name] = createBody(B, world, b, ['static', 'kinematic', 'dynamic'].indexOf(b.type));
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
    if (b.type === 'dynamic') setMass(B, body, b);
  }
  for (const joint of doc.joints) {
    const {type, localFrameA, localFrameB, ...fields} = choose(joint)['3'];
    const def = B[`b2Default${jointKinds[type]}JointDef`]();
    def.bodyIdA = bodies[joint.bodyA];
    def.bodyIdB = bodies[joint.bodyB];
    def.localAnchorA = vec(localFrameA.p);
    def.localAnchorB = vec(localFrameB.p);
    if ('localAxisA' in def) def.localAxisA = vec([Math.cos(localFrameA.angle), Math.sin(localFrameA.angle)]);
    if ('referenceAngle' in def) def.referenceAngle = localFrameA.angle - localFrameB.angle;
    setFields(def, type, fields);
    B[`b2Create${jointKinds[type]}Joint`](world, def);
  }
  return player(B, world, bodies);
}
