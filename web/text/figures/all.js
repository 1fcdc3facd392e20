// All figures: each registers itself when imported.
import "./01-mach.js";
import "./02-highlights.js";
import "./03-budget.js";
import "./04-depth.js";
import "./05-perspective.js";
import "./06-dac.js";
import "./07-loop.js";
import "./08-half.js";
import "./09-centres.js";
import "./10-edge.js";
import "./11-range.js";
import "./12-fixed.js";
