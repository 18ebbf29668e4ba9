// The entry of the bundle: the replay, on pages that have a place for it.
if (document.getElementById("replay-app")) import("./replay.js");
