//! Animations: keyframes for nodes.

use ::gltf::animation::{Interpolation as Way, Property as Path};
use ::gltf::{Animation, Document};

use super::LeftOut;
use super::accessor::Buffers;
use crate::model_file::rig::{Channel, Clip, Interpolation, Property, Sampler, Skeleton};

/// The animations that move a node.
pub(super) fn read(
    document: &Document,
    buffers: &Buffers,
    skeleton: &Skeleton,
    left_out: &mut LeftOut,
) -> Result<Vec<Clip>, String> {
    let mut stands = vec![false; skeleton.nodes.len()];
    skeleton.order.iter().for_each(|&node| stands[node] = true);
    let (mut clips, mut room) = (Vec::new(), MOST_KEYS);
    for animation in document.animations() {
        clips.extend(clip(&animation, buffers, &stands, (left_out, &mut room))?);
    }
    Ok(clips)
}

/// The maximum number of times and values of all animations: samplers may share accessors, so a small file could ask
/// for any amount of memory.
const MOST_KEYS: usize = 1 << 24;

/// One animation; `None` if it moves no node. `room` is the number of keys that may still be added.
fn clip(
    animation: &Animation<'_>,
    buffers: &Buffers,
    stands: &[bool],
    (left_out, room): (&mut LeftOut, &mut usize),
) -> Result<Option<Clip>, String> {
    let (mut samplers, mut channels) = (Vec::new(), Vec::new());
    // The index in `samplers` of each of the file's, for vectors and for rotations: two channels may share one.
    let mut places = vec![[None; 2]; animation.samplers().count()];
    for channel in animation.channels() {
        let target = channel.target();
        let property = match target.property() {
            Path::Translation => Property::Translation,
            Path::Rotation => Property::Rotation,
            Path::Scale => Property::Scale,
            Path::MorphTargetWeights => {
                left_out.insert("morph targets");
                continue;
            }
        };
        if !stands[target.node().index()] {
            continue;
        }
        let (sampler, is_rotation) = (channel.sampler(), property == Property::Rotation);
        let place = &mut places[sampler.index()][usize::from(is_rotation)];
        let sampler = match *place {
            Some(place) => place,
            None => {
                let part = || format!("animations[{}].samplers[{}]", animation.index(), sampler.index());
                let count = sampler.input().count().saturating_add(sampler.output().count());
                *room = room.checked_sub(count).ok_or_else(|| format!("{}: more than {MOST_KEYS} keys", part()))?;
                samplers.push(keys(&sampler, is_rotation, buffers).map_err(|what| format!("{}: {what}", part()))?);
                *place.insert(samplers.len() - 1)
            }
        };
        channels.push(Channel { node: target.node().index(), property, sampler });
    }
    let name = animation.name().unwrap_or_default();
    Ok((!channels.is_empty()).then(|| Clip::new(name.to_owned(), samplers, channels)))
}

fn keys(sampler: &::gltf::animation::Sampler<'_>, is_rotation: bool, buffers: &Buffers) -> Result<Sampler, String> {
    let times: Vec<f32> = buffers.rows::<1>(&sampler.input())?.into_iter().map(|[time]| time as f32).collect();
    let narrow = |c: f64| c as f32;
    let values: Vec<[f32; 4]> = match is_rotation {
        true => buffers.rows::<4>(&sampler.output())?.into_iter().map(|row| row.map(narrow)).collect(),
        false => {
            let rows = buffers.rows::<3>(&sampler.output())?.into_iter();
            rows.map(|[x, y, z]| [x, y, z, 0.0].map(narrow)).collect()
        }
    };
    let (interpolation, for_each) = match sampler.interpolation() {
        Way::Step => (Interpolation::Step, 1),
        Way::Linear => (Interpolation::Linear, 1),
        Way::CubicSpline => (Interpolation::CubicSpline, 3),
    };
    if times.is_empty() {
        return Err("no keys".into());
    }
    if values.len() / for_each < times.len() {
        return Err(format!("{} values for {} keys", values.len(), times.len()));
    }
    if let Some(time) = times.iter().find(|time| !time.is_finite()) {
        return Err(format!("a key at time {time}"));
    }
    if let Some(key) = times.windows(2).position(|pair| pair[0] > pair[1]) {
        return Err(format!("key {} is before key {key}", key + 1));
    }
    Ok(Sampler { interpolation, is_rotation, times, values })
}
