// What is bundled: the replay, on pages that have a place for it.
if (document.getElementById("replay-app")) import("./replay.js");
